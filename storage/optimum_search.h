// The exact optimum of a run's scenario, searched for beside the training on a thread of its own. While
// the training goes on, the search takes what the others leave of the processor. Its limit is processor
// time of its thread, so time in which it gets no processor does not count. Has no influence on what is
// learned. Thread-safe.
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

/// What is known of the least average AoI so far.
struct OptimumBound {
  double lower_bound_average_aoi = 0;  ///< no flight has a smaller one
  bool proved = false;                 ///< and one has it
};

/// How a search ended.
enum class SearchEnd {
  kOff,      ///< nothing was searched for
  kProved,   ///< the plan is the exact optimum
  kLimit,    ///< the limit of processor time or memory was reached first
  kStopped,  ///< Stop was called first
  kFailed,   ///< there is no plan; the log says why
};
/// "off", "proved", "limit", "stopped", "failed".
const char* SearchEndName(SearchEnd end);

/// What came out of a search that has ended.
struct OptimumResult {
  std::shared_ptr<const Plan> plan = nullptr;  ///< null for kOff and kFailed
  SearchEnd end = SearchEnd::kOff;
};

class OptimumSearch {
 public:
  struct Limits {
    double processor_seconds = 60;
    int64_t memory_bytes = int64_t{5} << 29;
  };
  /// Processor time of the calling thread, in microseconds.
  using ProcessorClock = std::function<int64_t()>;

  /// Starts searching. `world` must outlive the search. With a limit of 0 s nothing is searched for.
  /// `processor_clock` is called on the search's thread only.
  OptimumSearch(const World& world, Limits limits,
                ProcessorClock processor_clock = ThreadProcessorMicroseconds);
  /// Stops searching.
  ~OptimumSearch();
  OptimumSearch(const OptimumSearch&) = delete;
  OptimumSearch& operator=(const OptimumSearch&) = delete;

  /// What is proved by now; none before the first bound.
  std::optional<OptimumBound> bound() const;

  /// Seconds of processor time that the search may still take; 0 if it has ended.
  double processor_seconds_left() const;

  /// From now on the search's thread has the priority of the thread that made it. The system may refuse
  /// that to a program without privileges (RLIMIT_NICE); then the search keeps its low priority.
  void TakeFullPriority();

  /// Waits for the search's end, `timeout_us` at most. Returns whether it has ended.
  bool WaitForEnd(int64_t timeout_us);

  /// Ends the search now, and waits for it; its plan is then the best so far.
  void Stop();

  /// The result of a search that has ended.
  OptimumResult result() const;

 private:
  void Search();
  bool KeepGoing(const PlannerProgress& progress);
  SearchEnd EndOf(const Plan* plan) const;
  void TakeLowPriority();

  const World* world_;
  Limits limits_;
  ProcessorClock processor_clock_;
  int full_priority_;  // the nice value of the thread that made the search
  std::atomic<bool> stop_ = false;
  mutable std::mutex mutex_;
  std::condition_variable ended_changed_;
  double processor_seconds_ = 0;  // taken so far
  bool hurried_ = false;          // TakeFullPriority was called
  int thread_id_ = 0;             // the system's, of the search's thread; 0 before it runs
  bool ended_ = false;
  std::optional<OptimumBound> bound_;
  OptimumResult result_;
  std::thread thread_;
};

}  // namespace fresco
