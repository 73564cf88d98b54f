#include "core/thread_team.h"

#include <algorithm>

#include "core/error.h"

namespace fresco {
namespace {

// The bits of the number of parts, and of the next part, which goes beyond the parts by one a thread.
constexpr int kPartBits = 21;
constexpr uint64_t kPartMask = (uint64_t{1} << kPartBits) - 1;

// How often a thread looks for something before it lets others run or sleeps: some tens of microseconds.
constexpr int kLooks = 2000;

void Pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

uint64_t PartsOf(uint64_t state) {
  return state >> kPartBits & kPartMask;
}

}  // namespace

int ProcessorCount() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

ThreadTeam::ThreadTeam(int threads) {
  FRESCO_CHECK(threads >= 1);
  for (int i = 1; i < threads; ++i) {
    helpers_.emplace_back([this, i] { Help(i); });
  }
}

ThreadTeam::~ThreadTeam() {
  ends_ = true;
  RunParts(0, nullptr, nullptr);  // wakes those that sleep
  for (std::thread& helper : helpers_) {
    helper.join();
  }
}

void ThreadTeam::RunParts(int parts, Function function, void* work) {
  FRESCO_CHECK(parts >= 0 && parts <= kMaximumParts);
  function_ = function;
  work_ = work;
  done_.store(0, std::memory_order_relaxed);
  const uint64_t job = (state_.load(std::memory_order_relaxed) >> 2 * kPartBits) + 1;
  state_.store(job << 2 * kPartBits | static_cast<uint64_t>(parts) << kPartBits, std::memory_order_release);
  if (!helpers_.empty()) {
    state_.notify_all();
  }
  while (DoNextPart(0)) {
  }
  for (int looks = 0; done_.load(std::memory_order_acquire) < parts; ++looks) {
    if (looks < kLooks) {
      Pause();
    } else {
      std::this_thread::yield();  // the thread that has the last part may wait for this processor
    }
  }
}

/// Returns false if no part is left to take.
bool ThreadTeam::DoNextPart(int thread) {
  const uint64_t seen = state_.load(std::memory_order_acquire);
  if ((seen & kPartMask) >= PartsOf(seen)) {
    return false;
  }
  const uint64_t taken = state_.fetch_add(1, std::memory_order_acquire);
  const uint64_t part = taken & kPartMask;
  if (part >= PartsOf(taken)) {
    return false;
  }
  function_(work_, static_cast<int>(part), thread);
  done_.fetch_add(1, std::memory_order_release);
  return true;
}

void ThreadTeam::Help(int thread) {
  int looks = 0;
  while (!ends_) {
    const uint64_t seen = state_.load(std::memory_order_acquire);
    if (DoNextPart(thread)) {
      looks = 0;
    } else if (++looks < kLooks) {
      Pause();
    } else {
      looks = 0;
      state_.wait(seen, std::memory_order_acquire);
    }
  }
}

}  // namespace fresco
