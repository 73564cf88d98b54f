// Puts the events of a log back on a bus, their bytes as they are. Belongs to one thread.
#pragma once

#include <cstdint>
#include <optional>

#include "bus/bus.h"

namespace fresco {

class LogPlayer {
 public:
  /// `speed` times as fast as it was recorded; 0: as fast as receivers with default buffers can take it. No
  /// speed is faster than that. `bus` must outlive the player.
  LogPlayer(Bus& bus, double speed) : bus_(bus), speed_(speed) {}

  /// Waits for the event's time, unless the program is asked to stop, and publishes it.
  void Play(const LcmEvent& event);

  /// The next event is a first one: it is played at once.
  void StartAgain() { first_.reset(); }

  int64_t events() const { return events_; }
  /// Events that the bus did not take.
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
