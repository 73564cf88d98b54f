#include "logs/log_player.h"

#include <time.h>

#include <algorithm>
#include <string>

#include "core/clock.h"
#include "core/signals.h"

namespace fresco {
namespace {

// These limits give 20,000 messages of one frame a second. At this rate receivers with default buffers lose
// nothing.
constexpr int kBurstEvents = 8;
constexpr size_t kBurstBytes = 8 * 1400;
constexpr int64_t kBurstUs = 400;

/// Sleeps until then. Returns early if the program is asked to stop.
void WaitUntil(int64_t monotonic_us) {
  constexpr int64_t kSliceUs = 100'000;  // sleep in slices, since a signal may come just before a sleep
                                         // begins
  int64_t left_us = monotonic_us - MonotonicMicroseconds();
  while (left_us > 0 && !StopSignal::Requested()) {
    const timespec slice{0, std::min(left_us, kSliceUs) * 1000};
    nanosleep(&slice, nullptr);
    left_us = monotonic_us - MonotonicMicroseconds();
  }
}

}  // namespace

void LogPlayer::Play(const LcmEvent& event) {
  WaitForItsTime(event);
  Pace(event.message.size());
  if (!StopSignal::Requested()) {
    ++events_;
    refused_ += bus_.Publish(std::string(event.channel), event.message) ? 0 : 1;
  }
}

void LogPlayer::WaitForItsTime(const LcmEvent& event) {
  if (!first_) {
    first_ = {event.utime, MonotonicMicroseconds()};
  }
  if (speed_ > 0) {
    const double after_us = (static_cast<double>(event.utime) - static_cast<double>(first_->utime)) / speed_;
    constexpr double kLongestUs = 1e15;  // a damaged event may have any time
    WaitUntil(first_->monotonic_us + static_cast<int64_t>(std::clamp(after_us, 0.0, kLongestUs)));
  }
}

/// Waits if need be, so that there is at most one burst every 0.4 ms, and a longer pause after a large
/// message.
void LogPlayer::Pace(size_t bytes) {
  if (burst_events_ == kBurstEvents || burst_bytes_ >= kBurstBytes) {
    const auto share = static_cast<int64_t>(burst_bytes_ / kBurstBytes);
    WaitUntil(burst_begin_us_ + kBurstUs * std::max<int64_t>(1, share));
    burst_events_ = 0;
    burst_bytes_ = 0;
  }
  if (burst_events_ == 0) {
    burst_begin_us_ = MonotonicMicroseconds();
  }
  ++burst_events_;
  burst_bytes_ += bytes;
}

}  // namespace fresco
