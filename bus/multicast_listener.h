// Hears all LCM channels of a multicast group with a socket of its own, so that LCM, which believes every
// number in a packet, reads none of them. Used by one thread.
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "bus/bus.h"
#include "bus/lcm_url.h"
#include "bus/message_assembler.h"

namespace fresco {

/// What to do if a multicast group can't be joined.
inline constexpr char kMulticastRemedy[] =
    "most likely no route covers multicast; as root: ip route add 224.0.0.0/4 dev lo (as another user: "
    "unshare "
    "-Urn, then the same inside, after ip link set lo up), or the port is taken by another program";

class MulticastListener {
 public:
  /// From here on the kernel keeps what arrives. Throws UsageError, saying what to do, if the group can't be
  /// joined.
  explicit MulticastListener(const MulticastEndpoint& endpoint);
  ~MulticastListener();
  MulticastListener(const MulticastListener&) = delete;
  MulticastListener& operator=(const MulticastListener&) = delete;

  /// Whether a message of this channel arrives that `send` sends: again and again for ten seconds. Drops all
  /// other messages that arrive until then.
  bool Hears(const std::string& channel, const std::function<void()>& send);

  /// Readable if HandOut has something to read.
  int descriptor() const { return socket_; }
  /// Messages that have been read and wait to be handed out.
  bool has_waiting() const { return !waiting_.empty(); }

  /// Reads a batch of datagrams without waiting for any, then hands out up to `maximum` messages. Returns
  /// their number. What the handler throws leaves this function, too; the message counts as handed out.
  int HandOut(const BusEventHandler& handler, int maximum);

  UnheardTraffic unheard() const;

 private:
  static constexpr size_t kBatchDatagrams = 32;
  static constexpr size_t kDatagramBytes = 65'536;  // UDP has no larger one

  struct Waiting {
    int64_t utime;
    AssembledMessage message;
  };

  /// A datagram, and what the kernel says of it.
  struct Slot {
    std::array<std::byte, kDatagramBytes> datagram;
    iovec datagram_vector;
    sockaddr_in sender;
    alignas(cmsghdr) std::array<std::byte, CMSG_SPACE(sizeof(timeval))> control;
  };

  MulticastListener();
  void Receive();
  void Take(size_t index);

  int socket_;
  std::vector<Slot> slots_;
  std::vector<mmsghdr> headers_;  // of the slots
  MessageAssembler assembler_;
  std::deque<Waiting> waiting_;
  size_t waiting_bytes_ = 0;
  int64_t handed_out_ = 0;
};

}  // namespace fresco
