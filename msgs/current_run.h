// Tells a run that goes on from a recording of an earlier one that somebody sends again.
#pragma once

#include <cstdint>

namespace fresco {

/// How far the clocks of hosts may be apart.
inline constexpr int64_t kClockToleranceUs = 10'000'000;

/// Whether a learner's message of `utime` is of now by the clock of this host, `now_utime`, both in
/// microseconds since the epoch.
inline bool IsCurrent(int64_t utime, int64_t now_utime) {
  return utime >= now_utime - kClockToleranceUs && utime <= now_utime + kClockToleranceUs;
}

}  // namespace fresco
