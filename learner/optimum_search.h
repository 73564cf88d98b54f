// The exact optimum of a run's scenario, searched for beside the training on a thread of its own that
// takes what the others leave of the processor. Has no influence on what is learned. Thread-safe.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "uav/planner.h"

namespace fresco {

/// What is known of the least average AoI so far.
struct OptimumBound {
  double lower_bound_average_aoi = 0;  ///< no flight has a smaller one
  bool proved = false;                 ///< and one has it
};

class OptimumSearch {
 public:
  struct Limits {
    double seconds = 60;
    int64_t memory_bytes = int64_t{5} << 29;
  };

  /// Starts searching. `world` must outlive the search. With a limit of 0 s nothing is searched for.
  OptimumSearch(const World& world, Limits limits);
  /// Stops searching.
  ~OptimumSearch();
  OptimumSearch(const OptimumSearch&) = delete;
  OptimumSearch& operator=(const OptimumSearch&) = delete;

  /// What is proved by now; none before the first bound.
  std::optional<OptimumBound> bound() const;

  /// Seconds that the search may still go on; 0 where it has ended.
  double seconds_left() const;

  /// Waits for the search's end, `timeout_us` at most. Returns whether it has ended.
  bool WaitForEnd(int64_t timeout_us);

  /// Ends the search now, and waits for it; its plan is then the best so far.
  void Stop();

  /// The search's result once it has ended; null before, where nothing was searched for, and where it
  /// failed (said in the log).
  std::shared_ptr<const Plan> plan() const;

 private:
  void Search();
  bool KeepGoing(const PlannerProgress& progress);

  const World* world_;
  Limits limits_;
  int64_t begin_us_;
  std::atomic<bool> stop_ = false;
  mutable std::mutex mutex_;
  std::condition_variable ended_changed_;
  bool ended_ = false;
  std::optional<OptimumBound> bound_;
  std::shared_ptr<const Plan> plan_;
  std::thread thread_;
};

}  // namespace fresco
