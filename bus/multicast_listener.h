// Receives the messages of all LCM channels of a multicast group. It does not use LCM's own receiving code,
// which trusts every number in a packet. A thread of its own reads the socket, so no message is lost while
// the program is busy. Only one thread may call its functions.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "bus/bus.h"
#include "bus/lcm_url.h"
#include "bus/message_assembler.h"

namespace fresco {

/// What to do if a multicast group can't be joined, for an error's text.
inline constexpr char kMulticastRemedy[] =
    "most likely there is no route for multicast, or another program has taken the port; to add a "
    "route, run as root: ip route add 224.0.0.0/4 dev lo (without root: run unshare -Urn, and in its "
    "shell ip link set lo up and then the same command)";

/// A descriptor for poll(2) that is readable from Set until Clear. Any thread may use it.
class EventDescriptor {
 public:
  EventDescriptor();
  ~EventDescriptor();
  EventDescriptor(const EventDescriptor&) = delete;
  EventDescriptor& operator=(const EventDescriptor&) = delete;

  void Set();
  void Clear();
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

class MulticastListener {
 public:
  /// Joins the group and starts to listen; from now on no message is missed. Throws UsageError that says what
  /// to do if the group can't be joined.
  explicit MulticastListener(const MulticastEndpoint& endpoint);
  ~MulticastListener();

  /// Tests whether the socket receives: calls `send`, which sends a message on this channel, every 0.1 s
  /// until such a message arrives. Returns false if none arrives within ten seconds. Drops that message and
  /// all before it.
  bool Hears(const std::string& channel, const std::function<void()>& send);

  /// A descriptor that is readable if messages have arrived since the last HandOut took some from the thread.
  int descriptor() const { return arrival_.descriptor(); }
  /// Whether HandOut has taken messages from the thread and not handed them out yet. Call it again then,
  /// without waiting for the descriptor.
  bool has_left_over() const { return !taken_.empty(); }

  /// Calls the handler for up to `maximum` messages that have arrived, without waiting for any. Returns their
  /// number. If the handler throws, so does this function, and the message counts as handed out.
  int HandOut(const BusEventHandler& handler, int maximum);

  /// The traffic that could not be assembled so far.
  UnheardTraffic unheard() const;

 private:
  class Socket;
  struct Datagram;
  struct Arrived {
    int64_t utime;
    AssembledMessage message;
  };

  void Listen(const std::stop_token& stop);
  void Assemble(const Datagram& received);

  std::unique_ptr<Socket> socket_;  // used by the listening thread only
  MessageAssembler assembler_;      // used by the listening thread only

  std::deque<Arrived> taken_;  // taken from arrived_ by HandOut and not handed out yet
  int64_t handed_out_ = 0;

  EventDescriptor arrival_;
  EventDescriptor end_;
  mutable std::mutex mutex_;  // guards arrived_, arrived_bytes_ and unheard_
  std::condition_variable_any room_;
  std::deque<Arrived> arrived_;
  size_t arrived_bytes_ = 0;
  UnheardTraffic unheard_;

  std::jthread thread_;  // last member, so that the thread ends before the others are destroyed
};

}  // namespace fresco
