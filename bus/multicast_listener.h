// Hears all LCM channels of a multicast group without LCM, which believes every number in a packet. A thread
// of its own empties the socket, so that nothing is lost while the program does something else. Its functions
// belong to one thread.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "bus/bus.h"
#include "bus/lcm_url.h"
#include "bus/message_assembler.h"
#include "bus/multicast_socket.h"

namespace fresco {

/// A descriptor that can be waited for: readable from Set until Clear. Any thread.
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
  /// Begins to listen. Throws UsageError as MulticastSocket does.
  explicit MulticastListener(const MulticastEndpoint& endpoint);

  /// Whether a message of this channel arrives that `send` sends: again and again for ten seconds. Drops all
  /// messages up to this one.
  bool Hears(const std::string& channel, const std::function<void()>& send);

  /// Readable if messages have arrived that HandOut has not looked at.
  int descriptor() const { return arrival_.descriptor(); }
  /// Whether HandOut has messages that it has looked at and not handed out.
  bool has_left_over() const { return !taken_.empty(); }

  /// Hands out up to `maximum` of the messages that have arrived, without waiting for any. Returns their
  /// number. What the handler throws leaves this function, too; that message counts as handed out.
  int HandOut(const BusEventHandler& handler, int maximum);

  UnheardTraffic unheard() const;

 private:
  struct Arrived {
    int64_t utime;
    AssembledMessage message;
  };

  void Listen(const std::stop_token& stop);
  void Take(const ReceivedDatagram& received);

  MulticastSocket socket_;  // of the thread
  MessageAssembler assembler_;

  std::deque<Arrived> taken_;  // for HandOut
  int64_t handed_out_ = 0;

  EventDescriptor arrival_;
  EventDescriptor end_;
  mutable std::mutex mutex_;  // guards what follows
  std::condition_variable_any room_;
  std::deque<Arrived> arrived_;
  size_t arrived_bytes_ = 0;
  UnheardTraffic unheard_;

  std::jthread thread_;  // ends first
};

}  // namespace fresco
