// Time, for time stamps, deadlines and rates only. Nothing read here may reach the weights.
// Thread-safe.
#pragma once

#include <cstdint>

namespace fresco {

/// Microseconds since the Unix epoch: the `utime` of every message.
int64_t WallMicroseconds();

/// Microseconds of a clock that never jumps, from an arbitrary origin: for deadlines and rates.
int64_t MonotonicMicroseconds();

/// Processor time that the calling thread has taken so far, in microseconds: it stands still while the
/// thread waits for a processor or for anything else.
int64_t ThreadProcessorMicroseconds();

}  // namespace fresco
