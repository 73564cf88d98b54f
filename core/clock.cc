#include "core/clock.h"

#include <algorithm>
#include <chrono>
#include <ctime>

namespace fresco {
namespace {

template <class Clock>
int64_t Microseconds() {
  return std::chrono::duration_cast<std::chrono::microseconds>(Clock::now().time_since_epoch()).count();
}

int64_t MicrosecondsOf(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return int64_t{time.tv_sec} * 1'000'000 + time.tv_nsec / 1000;
}

}  // namespace

int64_t WallMicroseconds() {
  return Microseconds<std::chrono::system_clock>();
}

int64_t MonotonicMicroseconds() {
  return Microseconds<std::chrono::steady_clock>();
}

int64_t ThreadProcessorMicroseconds() {
  return MicrosecondsOf(CLOCK_THREAD_CPUTIME_ID);
}

int64_t ProcessProcessorMicroseconds() {
  return MicrosecondsOf(CLOCK_PROCESS_CPUTIME_ID);
}

int64_t AttentiveClock::Look(int64_t monotonic_us) {
  if (looked_) {
    now_us_ += std::clamp<int64_t>(monotonic_us - last_look_us_, 0, kLongestGapUs);
  }
  looked_ = true;
  last_look_us_ = monotonic_us;
  return now_us_;
}

double RateMeter::Measure(int64_t count, int64_t now_us) {
  constexpr int64_t kPeriodUs = 1'000'000;
  if (now_us - since_us_ >= kPeriodUs) {
    per_s_ = static_cast<double>(count - since_count_) / (static_cast<double>(now_us - since_us_) * 1e-6);
    since_us_ = now_us;
    since_count_ = count;
  }
  return per_s_;
}

}  // namespace fresco
