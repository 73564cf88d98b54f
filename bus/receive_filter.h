// Keeps from a process whatever LCM would read wrongly or for nothing. LCM 1.3.1 writes outside its memory
// where the header of a fragment ("LC03") lies, joins fragments to messages of up to 256 MiB, and remembers
// every channel name that it ever saw. Fresco's messages are one datagram each, on channels that are known.
//
// Used by one thread, while LCM's own reads from the socket.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fresco {

/// The sockets with which this process receives on the UDP port `port`. Throws Failure where /proc/self/fd
/// can't be read.
std::vector<int> ReceivingSockets(uint16_t port);

/// What the kernel hands to one UDP socket that LCM reads; the rest it drops, and counts with the datagrams
/// that found no room (/proc/net/udp). All throw Failure where the kernel refuses.
class ReceiveFilter {
 public:
  /// From now on nothing passes. `socket` stays open for longer than the filter is used.
  explicit ReceiveFilter(int socket);

  /// Whole messages ("LC02") of exactly this channel pass, too. A name that LCM can have: up to 63 bytes, no
  /// zero.
  void Pass(const std::string& channel);

  /// Everything passes, fragments too, whatever LCM makes of it; Pass changes nothing afterwards.
  void PassAll();

 private:
  void Attach() const;

  int socket_;
  bool passes_all_ = false;
  std::vector<std::string> channels_;
};

}  // namespace fresco
