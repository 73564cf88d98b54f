// A clock for judging the silence of others: it goes on only while its owner looks at it. Time in which
// the process was stopped, or its host asleep, is not time in which others said nothing. Not
// thread-safe.
#pragma once

#include <algorithm>
#include <cstdint>

namespace fresco {

class AttentiveClock {
 public:
  /// The longest time between two looks that still counts as listening.
  static constexpr int64_t kLongestGapUs = 100'000;

  /// Looks at the clock; `monotonic_us` is that of MonotonicMicroseconds. Returns now_us().
  int64_t Look(int64_t monotonic_us) {
    if (looked_) {
      now_us_ += std::clamp<int64_t>(monotonic_us - last_look_us_, 0, kLongestGapUs);
    }
    looked_ = true;
    last_look_us_ = monotonic_us;
    return now_us_;
  }

  /// Microseconds of listening, from an arbitrary origin, at the last look.
  int64_t now_us() const { return now_us_; }

 private:
  bool looked_ = false;
  int64_t last_look_us_ = 0;
  int64_t now_us_ = 1;  // so that 0 may stand for "never"
};

}  // namespace fresco
