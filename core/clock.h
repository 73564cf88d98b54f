// Time, for time stamps, deadlines and rates only. Nothing read here may reach the weights. Any thread may
// call the functions.
#pragma once

#include <cstdint>

namespace fresco {

/// Microseconds since the Unix epoch: the `utime` of every message.
int64_t WallMicroseconds();

/// Microseconds of a clock that never jumps, from an arbitrary origin: for deadlines and rates.
int64_t MonotonicMicroseconds();

/// Processor time that the calling thread has used so far, in microseconds. It does not advance while
/// the thread waits for a processor or for anything else.
int64_t ThreadProcessorMicroseconds();

/// The same of all threads of this process.
int64_t ProcessProcessorMicroseconds();

/// A clock for judging the silence of others: it advances only while its owner looks at it. Time in which the
/// process was stopped, or its host asleep, is not time in which others said nothing. Not thread-safe.
class AttentiveClock {
 public:
  /// The longest time between two looks that still counts as listening.
  static constexpr int64_t kLongestGapUs = 100'000;

  /// Looks at the clock; `monotonic_us` is that of MonotonicMicroseconds. Returns now_us().
  int64_t Look(int64_t monotonic_us);

  /// Microseconds of listening, from an arbitrary origin, at the last look.
  int64_t now_us() const { return now_us_; }

 private:
  bool looked_ = false;
  int64_t last_look_us_ = 0;
  int64_t now_us_ = 1;  // so that 0 can mean "never"
};

/// Measures how fast a count grows, over times of at least a second. Not thread-safe.
class RateMeter {
 public:
  /// Looks at the count; returns its newest rate, per second.
  double Measure(int64_t count, int64_t now_us);

 private:
  int64_t since_us_ = 0;
  int64_t since_count_ = 0;
  double per_s_ = 0;
};

}  // namespace fresco
