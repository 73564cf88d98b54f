// Fresco's messages over a bus. Publish adds the run and the time to a message and encodes it. Subscribe
// decodes what arrives and counts what does not decode; KeyMismatch reports messages with a wrong or
// missing key.
//
// Threads: Publish from any thread; Subscribe and the handlers on the thread that polls the bus; the counters
// from any thread.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bus/bus.h"
#include "core/clock.h"
#include "msgs/wire.h"

namespace fresco {

class MessageBus {
 public:
  /// `bus` must outlive the object, but must not be polled after the object is destroyed.
  explicit MessageBus(Bus& bus) : bus_(&bus) {}
  MessageBus(const MessageBus&) = delete;
  MessageBus& operator=(const MessageBus&) = delete;

  /// Writes this identity and the present time into the message, and sends it. Returns false if the transport
  /// reports that it could not.
  template <class Message>
  bool Publish(const std::string& channel, Message&& message, RunIdentity identity) {
    thread_local std::vector<std::byte> bytes;  // so that sending allocates nothing after a while
    Stamp(message, identity, WallMicroseconds());
    Encode(message, bytes);
    return bus_->Publish(channel, bytes);
  }

  /// Calls `handler` for every message of this channel that decodes. The message is valid during the call.
  /// Throws UsageError as Bus::Subscribe does.
  template <class Message>
  void Subscribe(const std::string& channel, std::function<void(const Message&)> handler,
                 int queue_capacity = kDefaultQueueCapacity) {
    const auto receive = [this, handler = std::move(handler),
                          message = std::make_shared<Message>()](std::span<const std::byte> bytes) {
      if (Decode(bytes, *message)) {
        handler(*message);
      } else {
        NoteMalformed(bytes);
      }
    };
    bus_->Subscribe(channel, receive, queue_capacity);
  }

  int Poll(int64_t timeout_us) { return bus_->Poll(timeout_us); }

  /// Messages that did not decode.
  int64_t malformed_messages() const { return malformed_; }
  /// Messages that the bus refused because they were not made with this program's key.
  int64_t unauthenticated_messages() const { return bus_->refused_messages(); }

  /// How many messages were dropped because sender and receiver do not have the same key; empty if none
  /// was. For error messages and the status.
  std::string KeyMismatch() const;
  /// KeyMismatch's text at the first call after it is no longer empty; empty at every other call. Call it on
  /// one thread only.
  std::string KeyMismatchNews();

 private:
  void NoteMalformed(std::span<const std::byte> bytes);

  Bus* bus_;
  std::atomic<int64_t> malformed_ = 0;
  std::atomic<int64_t> with_unknown_key_ = 0;  // of these: made with a key, and this program has none
  bool told_ = false;
};

}  // namespace fresco
