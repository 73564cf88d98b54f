// Searches for the exact optimum of a run's scenario on a thread of its own, during the training. The thread
// has a low priority, so it takes only processor time that the others leave. The limit counts processor time
// of this thread, so time in which it does not run does not count. Has no influence on what is learned.
// LearnerProcess owns one. Any thread may call any function.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "core/clock.h"
#include "planner/planner.h"

namespace fresco {

/// What has been proved about the least average AoI so far.
struct OptimumBound {
  double lower_bound_average_aoi = 0;  ///< no flight has a smaller average AoI, slots
  bool proved = false;                 ///< some flight has exactly this average AoI
};

/// How a search ended.
enum class SearchEnd {
  kOff,      ///< there was no search
  kProved,   ///< it found the exact optimum and proved it
  kLimit,    ///< it reached the limit of processor time or memory before
  kStopped,  ///< Stop was called before
  kFailed,   ///< it failed; the log says why
};
/// "off", "proved", "limit", "stopped", "failed".
const char* SearchEndName(SearchEnd end);

/// The result of a search that has ended.
struct OptimumResult {
  std::shared_ptr<const Plan> plan = nullptr;  ///< null for kOff and kFailed
  SearchEnd end = SearchEnd::kOff;
  double processor_seconds = 0;  ///< what the search took
};

class OptimumSearch {
 public:
  struct Limits {
    double processor_seconds = 60;            ///< 0: no search
    int64_t memory_bytes = int64_t{5} << 29;  ///< 2.5 GiB
  };
  /// Returns the processor time of the calling thread, microseconds.
  using ProcessorClock = std::function<int64_t()>;

  /// Starts the search, if the planner knows this kind of world. `world` must outlive the object.
  /// `processor_clock` is called on the search's thread only.
  OptimumSearch(const World& world, Limits limits,
                ProcessorClock processor_clock = ThreadProcessorMicroseconds);
  /// Stops the search.
  ~OptimumSearch();
  OptimumSearch(const OptimumSearch&) = delete;
  OptimumSearch& operator=(const OptimumSearch&) = delete;

  /// What has been proved so far; none before the first bound.
  std::optional<OptimumBound> bound() const;

  /// Seconds of processor time that the search may still take; 0 if it has ended.
  double processor_seconds_left() const;

  /// Until this is called, the search's thread runs only while a processor has nothing else to do
  /// (SCHED_IDLE). The system may refuse the change to a program without privileges (RLIMIT_NICE).
  void SetFullPriority();

  /// Waits at most `timeout_us` until the search ends. Returns whether it has ended.
  bool WaitForEnd(int64_t timeout_us);

  /// Stops the search and waits until it has ended. Its plan is then the best flight found so far.
  void Stop();

  /// The result. Call it after the search has ended.
  OptimumResult result() const;

 private:
  void Search();
  bool KeepGoing(const PlannerProgress& progress);
  SearchEnd EndOf(const Plan* plan) const;
  void SetLowPriority();

  const World* world_;
  Limits limits_;
  ProcessorClock processor_clock_;
  std::atomic<bool> stop_ = false;
  mutable std::mutex mutex_;
  std::condition_variable ended_changed_;
  double processor_seconds_ = 0;  // taken so far
  bool hurried_ = false;          // SetFullPriority was called
  int thread_id_ = 0;             // the system's id of the search's thread; 0 before it runs
  bool ended_ = false;
  std::optional<OptimumBound> bound_;
  OptimumResult result_;
  std::thread thread_;
};

}  // namespace fresco
