// Publishes the events of a log on a bus again, with unchanged bytes. Only one thread may use an object.
#pragma once

#include <cstdint>
#include <optional>

#include "bus/bus.h"

namespace fresco {

class LogPlayer {
 public:
  /// Plays `speed` times as fast as the events were recorded, or if `speed` is 0 as fast as possible. But it
  /// never plays faster than receivers with default buffers can follow. `bus` must outlive the player.
  LogPlayer(Bus& bus, double speed) : bus_(bus), speed_(speed) {}

  /// Waits until it is time for the event, or until the program is asked to stop, and publishes it.
  void Play(const LcmEvent& event);

  /// Starts the clock again: the next event is published at once.
  void StartAgain() { first_.reset(); }

  /// The number of events published.
  int64_t events() const { return events_; }
  /// The number of events that the bus could not send.
  int64_t refused() const { return refused_; }

 private:
  struct Beginning {
    int64_t utime;
    int64_t monotonic_us;
  };

  void WaitForItsTime(const LcmEvent& event);
  void Pace(size_t bytes);

  Bus& bus_;
  double speed_;
  std::optional<Beginning> first_;
  int64_t burst_begin_us_ = 0;
  int burst_events_ = 0;
  size_t burst_bytes_ = 0;
  int64_t events_ = 0;
  int64_t refused_ = 0;
};

}  // namespace fresco
