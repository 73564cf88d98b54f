// A socket that receives what is sent to a multicast group, as LCM's own does. Used by one thread.
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

/// What to do if a multicast group can't be joined.
inline constexpr char kMulticastRemedy[] =
    "most likely no route covers multicast; as root: ip route add 224.0.0.0/4 dev lo (as another user: "
    "unshare "
    "-Urn, then the same inside, after ip link set lo up), or the port is taken by another program";

/// `datagram` is valid during the call only.
struct ReceivedDatagram {
  std::span<const std::byte> datagram;
  uint64_t sender;  ///< IPv4 address and port as one number
  int64_t utime;    ///< microseconds since the epoch, when the kernel received it
};

class MulticastSocket {
 public:
  /// From here on the kernel keeps what arrives. Throws UsageError, saying what to do, if the group can't be
  /// joined.
  explicit MulticastSocket(const MulticastEndpoint& endpoint);
  ~MulticastSocket();
  MulticastSocket(const MulticastSocket&) = delete;
  MulticastSocket& operator=(const MulticastSocket&) = delete;

  int descriptor() const { return socket_; }

  /// Calls `take` for each of the datagrams that have arrived, a batch of them at most. Waits for none.
  void Receive(const std::function<void(const ReceivedDatagram&)>& take);

 private:
  static constexpr size_t kBatchDatagrams = 32;
  static constexpr size_t kDatagramBytes = 65'536;  // UDP has no larger one

  /// Room for a datagram and for what the kernel says of it.
  struct Slot {
    std::array<std::byte, kDatagramBytes> datagram;
    iovec datagram_vector;
    sockaddr_in sender;
    alignas(cmsghdr) std::array<std::byte, CMSG_SPACE(sizeof(timeval))> control;
  };

  MulticastSocket();

  int socket_;
  std::vector<Slot> slots_;
  std::vector<mmsghdr> headers_;  // of the slots
};

}  // namespace fresco
