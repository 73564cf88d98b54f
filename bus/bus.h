// Transport only: channels of bytes over LCM. Knows no message of Fresco's.
//
// Threads: Publish may be called from any thread; Subscribe and Poll belong to one thread, on which
// the handlers run. An exception that leaves a handler is kept while LCM's C code returns and is
// thrown again by Poll.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "bus/lcm_event.h"

namespace fresco {

/// The message's bytes are valid during the call only.
using BusHandler = std::function<void(std::span<const std::byte> message)>;
/// The event is valid during the call only.
using BusEventHandler = std::function<void(const LcmEvent& event)>;

/// Messages of one channel that may wait for Poll; LCM drops what comes beyond (memq:// keeps all). At 40,000
/// a second, the most that the pacing of networks allows, enough for a twentieth of a second in which nobody
/// polls; what is lost is sent again. It bounds the memory that a flood can take from a program whose polling
/// thread is busy: LCM counts messages, not bytes, and a datagram that is none of ours has up to 64 KiB, so
/// 2048 x 64 KiB = 128 MiB a channel (Fresco's own messages: 2048 x 1350 bytes, under 3 MiB).
inline constexpr int kDefaultQueueCapacity = 2048;

/// What SubscribeToAll heard on udpm and could not hand out.
struct UnheardTraffic {
  int64_t refused_packets = 0;      ///< not LCM's, or damaged, or a fragment that contradicts another
  int64_t incomplete_messages = 0;  ///< fragments are missing
};

class Bus {
 public:
  virtual ~Bus() = default;

  /// Sends one message. Returns false where the transport said that it could not (counted by the
  /// caller; the network may lose it silently all the same).
  virtual bool Publish(const std::string& channel, std::span<const std::byte> message) = 0;

  /// Calls `handler` for every message of exactly this channel (the name is escaped: LCM reads
  /// channels as regular expressions). Throws UsageError where LCM refuses (a firewall that drops
  /// multicast; a name that it can't have), saying what to do; Failure where LCM's socket can't be found or
  /// filtered (bus/receive_filter.h). Keeps up to `queue_capacity` messages that
  /// wait for Poll. With udpm, messages of more than one datagram (64 KiB) do not arrive:
  /// bus/receive_filter.h.
  virtual void Subscribe(const std::string& channel, BusHandler handler,
                         int queue_capacity = kDefaultQueueCapacity) = 0;

  /// Calls `handler` for every message of every channel, as it stands on the wire (an authenticated bus
  /// checks and removes nothing here), also of many datagrams: for those who record. To be called once. With
  /// udpm LCM takes no part in it: bus/multicast_listener.h. Throws UsageError as Subscribe does.
  virtual void SubscribeToAll(BusEventHandler handler) = 0;

  /// Handles what has arrived, or waits up to `timeout_us` microseconds for the first message; never
  /// handles more than `maximum_messages`. Returns the number of messages handled. Returns early,
  /// with 0, where a signal arrives.
  virtual int Poll(int64_t timeout_us, int maximum_messages = 1000) = 0;

  /// Messages that the bus refused before any handler saw them; see bus/authenticated_bus.h. From any thread.
  virtual int64_t refused_messages() const { return 0; }

  /// So far; on the thread that polls.
  virtual UnheardTraffic unheard() const { return {}; }
};

/// The URL used where none is given: this machine only (ttl 0), with a receive buffer of 4 MB.
inline constexpr char kDefaultLcmUrl[] = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304";

/// A bus over LCM: udpm://, tcpq:// or memq:// (private to the one object). A udpm URL without
/// recv_buf_size gets one of 4 MB, one without ttl gets ttl=0. With udpm the first subscription opens what
/// receives, so that a program that only sends hears nothing. Throws UsageError where the URL does not parse
/// or the provider can't start (no multicast route, no tcpq server), naming the URL, the cause and
/// the command that mends it.
std::unique_ptr<Bus> OpenLcmBus(const std::string& url);

}  // namespace fresco
