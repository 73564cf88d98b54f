// A kernel filter that lets LCM receive only unfragmented messages of subscribed channels. It is needed
// because LCM 1.3.1 writes outside its memory if the header of a fragment ("LC03") is forged, joins fragments
// to messages of up to 256 MiB, and remembers every channel name that it ever saw. All of Fresco's messages
// fit one datagram. Programs that receive all channels do not use LCM for it (bus/multicast_listener.h).
//
// One thread may use a filter; LCM's own thread may read the socket at the same time.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace fresco {

/// The mutex to hold while opening or closing a socket that receives from a bus, so that SocketOpenedBy sees
/// only one new socket.
std::mutex& ReceivingSockets();

/// Calls `open` and returns the socket on UDP port `port` that it opened. LCM does not say which socket is
/// its own, so this compares the process's sockets before and after. Throws what `open` throws, and Failure
/// if there is not exactly one new socket or /proc/self/fd can't be read.
int SocketOpenedBy(const std::function<void()>& open, uint16_t port);

/// The filter of one UDP socket that LCM reads. The kernel drops all other datagrams, and counts them
/// together with those that found the buffer full (/proc/net/udp). Both functions throw Failure if the kernel
/// refuses the filter.
class ReceiveFilter {
 public:
  /// From now on no datagram passes. `socket` must stay open while the filter is used.
  explicit ReceiveFilter(int socket);

  /// From now on unfragmented messages ("LC02") of exactly this channel pass, too. `channel` has at most 63
  /// bytes and no zero byte.
  void Pass(const std::string& channel);

 private:
  void Attach() const;

  int socket_;
  std::vector<std::string> channels_;
};

}  // namespace fresco
