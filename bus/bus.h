// A bus sends and receives bytes on named channels over LCM. It does not know Fresco's message types.
//
// Threads: any thread may call Publish. Only one thread may call Subscribe and Poll; Poll runs the handlers
// on that thread. If a handler throws, the exception is kept until LCM's C code has returned, and then Poll
// throws it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace fresco {

/// One message as it was on the bus, or as an event log of LCM stores it. `channel` and `message` point into
/// memory of the object that handed the event out, which says how long they are valid.
struct LcmEvent {
  int64_t number = 0;  ///< 0, 1, .. in the order of the log, or in the order of arrival on a bus
  int64_t utime = 0;   ///< time of arrival, microseconds since the epoch
  std::string_view channel = {};
  std::span<const std::byte> message = {};
};

/// Called with one message. The bytes are valid during the call only.
using BusHandler = std::function<void(std::span<const std::byte> message)>;
/// Called with one event. The event is valid during the call only.
using BusEventHandler = std::function<void(const LcmEvent& event)>;

/// How many messages of one channel may wait for Poll. LCM drops further ones (memq:// drops none); Fresco
/// sends lost messages again. The learner sends at most 40,000 chunks of networks a second, so the queue
/// lasts for a twentieth of a second without a Poll. The limit bounds the memory that a flood of messages can
/// take. LCM counts messages, not bytes, and a foreign datagram has up to 64 KiB, so that is 2048 x 64 KiB =
/// 128 MiB a channel; for Fresco's own messages it is 2048 x 1350 bytes, under 3 MiB.
inline constexpr int kDefaultQueueCapacity = 2048;

/// Counts what SubscribeToAll received over udpm but could not give to its handler.
struct UnheardTraffic {
  int64_t refused_packets = 0;      ///< packets that are not LCM's or damaged, and fragments that contradict
                                    ///< others
  int64_t incomplete_messages = 0;  ///< messages with missing fragments
};

class Bus {
 public:
  virtual ~Bus() = default;

  /// Sends one message. Returns false if the transport reports that it could not send it. The network may
  /// lose a message even if this returns true.
  virtual bool Publish(const std::string& channel, std::span<const std::byte> message) = 0;

  /// From now on, Poll calls `handler` for every message on exactly this channel; the name is not a regular
  /// expression. At most `queue_capacity` (>= 1) messages wait for Poll. Over udpm, messages larger than one
  /// datagram (64 KiB) do not arrive (bus/receive_filter.h). Throws UsageError that says what to do if LCM
  /// can't subscribe, for example because a firewall drops multicast or the name is too long. Throws Failure
  /// if LCM's socket can't be found or filtered.
  virtual void Subscribe(const std::string& channel, BusHandler handler,
                         int queue_capacity = kDefaultQueueCapacity) = 0;

  /// From now on, Poll calls `handler` for every message on every channel, exactly as it is on the wire:
  /// messages of several datagrams arrive too, and an authenticated bus neither checks nor removes tags here.
  /// For programs that record. Call it at most once. Over udpm it does not use LCM but
  /// bus/multicast_listener.h. Throws UsageError as Subscribe does.
  virtual void SubscribeToAll(BusEventHandler handler) = 0;

  /// Calls the handlers for messages that have arrived, at most `maximum_messages`. If none has arrived,
  /// waits up to `timeout_us` microseconds for the first. Returns the number of messages handled. Returns 0
  /// early if the process receives a signal. Throws what a handler threw, and Failure if the connection was
  /// lost.
  virtual int Poll(int64_t timeout_us, int maximum_messages = 1000) = 0;

  /// The number of messages dropped so far because they were not authentic; see bus/authenticated_bus.h. Any
  /// thread may call this.
  virtual int64_t refused_messages() const { return 0; }

  /// The traffic so far that SubscribeToAll could not give to its handler. Call it on the thread that polls.
  virtual UnheardTraffic unheard() const { return {}; }
};

/// The URL used if none is given: it reaches this machine only (ttl 0) and has a receive buffer of 4 MB.
inline constexpr char kDefaultLcmUrl[] = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304";

/// Opens a bus over LCM. The URL is udpm://, tcpq:// or memq:// (a bus that only this object uses). For udpm,
/// the defaults are recv_buf_size=4194304 and ttl=0, and only the first subscription opens the receiving
/// socket, so a program that only sends receives nothing. Throws UsageError if the URL does not parse or LCM
/// can't start (no multicast route, no tcpq server); the error names the URL, the cause and a command that
/// helps.
std::unique_ptr<Bus> OpenLcmBus(const std::string& url);

}  // namespace fresco
