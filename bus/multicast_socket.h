// A socket that receives the datagrams sent to a multicast group, as LCM's own socket does. MulticastListener
// owns one. Only one thread may use it.
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "bus/lcm_url.h"

namespace fresco {

/// What to do if a multicast group can't be joined, for an error's text.
inline constexpr char kMulticastRemedy[] =
    "most likely there is no route for multicast, or another program has taken the port; to add a "
    "route, run as root: ip route add 224.0.0.0/4 dev lo (without root: run unshare -Urn, and in its "
    "shell ip link set lo up and then the same command)";

/// `datagram` is valid during the call only.
struct ReceivedDatagram {
  std::span<const std::byte> datagram;
  uint64_t sender;  ///< IPv4 address and port as one number
  int64_t utime;    ///< microseconds since the epoch, when the kernel received it
};

class MulticastSocket {
 public:
  /// Joins the group; from now on the kernel keeps arriving datagrams. Throws UsageError that says what to do
  /// if the group can't be joined.
  explicit MulticastSocket(const MulticastEndpoint& endpoint);
  ~MulticastSocket();
  MulticastSocket(const MulticastSocket&) = delete;
  MulticastSocket& operator=(const MulticastSocket&) = delete;

  int descriptor() const { return socket_; }

  /// Calls `take` for each datagram that has arrived, but at most for one batch. Does not wait.
  void Receive(const std::function<void(const ReceivedDatagram&)>& take);

 private:
  static constexpr size_t kBatchDatagrams = 32;
  static constexpr size_t kDatagramBytes = 65'536;  // the largest UDP datagram

  /// Buffers for a datagram, its sender and its time of arrival.
  struct Slot {
    std::array<std::byte, kDatagramBytes> datagram;
    iovec datagram_vector;
    sockaddr_in sender;
    alignas(cmsghdr) std::array<std::byte, CMSG_SPACE(sizeof(timeval))> control;
  };

  MulticastSocket();

  int socket_;
  std::vector<Slot> slots_;
  std::vector<mmsghdr> headers_;  // they point into slots_
};

}  // namespace fresco
