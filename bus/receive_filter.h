// Keeps from a process whatever LCM would read wrongly or for nothing. LCM 1.3.1 writes outside its memory
// where the header of a fragment ("LC03") lies, joins fragments to messages of up to 256 MiB, and remembers
// every channel name that it ever saw. Fresco's messages are one datagram each, on channels that are known.
// Who hears all channels does so without LCM (bus/multicast_listener.h).
//
// Used by one thread, while LCM's own reads from the socket.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace fresco {

/// To be held while a socket that receives from a bus is opened or closed.
std::mutex& ReceivingSockets();

/// Calls `open` and returns the socket on the UDP port `port` that it opened: LCM does not tell which one is
/// its own. Throws what `open` throws, and Failure if there is not exactly one or /proc/self/fd can't be
/// read.
int SocketOpenedBy(const std::function<void()>& open, uint16_t port);

/// What the kernel hands to one UDP socket that LCM reads; the rest it drops, and counts with the datagrams
/// that found no room (/proc/net/udp). All throw Failure where the kernel refuses.
class ReceiveFilter {
 public:
  /// From now on nothing passes. `socket` stays open for longer than the filter is used.
  explicit ReceiveFilter(int socket);

  /// Whole messages ("LC02") of exactly this channel pass, too. A name that LCM can have: up to 63 bytes, no
  /// zero.
  void Pass(const std::string& channel);

 private:
  void Attach() const;

  int socket_;
  std::vector<std::string> channels_;
};

}  // namespace fresco
