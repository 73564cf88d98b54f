#include "core/clock.h"

#include <chrono>

namespace fresco {
namespace {

template <class Clock>
int64_t Microseconds() {
  return std::chrono::duration_cast<std::chrono::microseconds>(Clock::now().time_since_epoch()).count();
}

}  // namespace

int64_t WallMicroseconds() {
  return Microseconds<std::chrono::system_clock>();
}

int64_t MonotonicMicroseconds() {
  return Microseconds<std::chrono::steady_clock>();
}

}  // namespace fresco
