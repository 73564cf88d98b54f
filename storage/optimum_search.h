// Searches for the exact optimum of a run's evaluation episodes on a thread of its own, during the training.
// It plans one episode after the other. The thread has a low priority, so it takes only processor time that
// the others leave. The limit counts processor time of this thread, so time in which it does not run does not
// count. Has no influence on what is learned. LearnerProcess owns one. Any thread may call any function.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "core/clock.h"
#include "msgs/experiment.h"
#include "planner/planner.h"

namespace fresco {

/// What has been proved about the least average AoI of an episode so far.
struct OptimumBound {
  double lower_bound_average_aoi = 0;  ///< no flight has a smaller average AoI, slots; 0: nothing is known
  bool proved = false;                 ///< some flight has exactly this average AoI
};

/// How far scores are above the least ones, percent.
struct Gaps {
  double mean = 0;
  double median = 0;
  double worst = 0;
};
/// `scores` and `least_scores` by episode, as many of each, at least one.
Gaps GapsOf(std::span<const double> scores, std::span<const double> least_scores);

/// The seeds of the episodes whose optimum belongs to a run: one if all episodes are the same, otherwise
/// those of fixed evaluations, then those of the delivery (training/schedules.h). Empty if the planner does
/// not know the world, or if every evaluation has fresh episodes.
std::vector<uint64_t> EpisodesToPlan(const Experiment& experiment);

/// How a search ended.
enum class SearchEnd {
  kOff,      ///< there was no search
  kProved,   ///< it found the exact optimum of every episode and proved it
  kLimit,    ///< it reached the limit of processor time or memory before
  kStopped,  ///< Stop was called before
  kFailed,   ///< it failed; the log says why
};
/// "off", "proved", "limit", "stopped", "failed".
const char* SearchEndName(SearchEnd end);

/// The result of a search that has ended.
struct OptimumResult {
  std::vector<std::shared_ptr<const Plan>> plans = {};  ///< by episode; null if there is none
  SearchEnd end = SearchEnd::kOff;
  double processor_seconds = 0;  ///< what the search took
};

class OptimumSearch {
 public:
  struct Limits {
    /// For all episodes together; 0: no search. If there are several, each may take a tenth of it.
    double processor_seconds = 60;
    int64_t memory_bytes = int64_t{5} << 29;  ///< 2.5 GiB
  };
  /// Returns the processor time of the calling thread, microseconds.
  using ProcessorClock = std::function<int64_t()>;

  /// Starts the search for the optimum of the episodes of `seeds`, if the planner knows this kind of world.
  /// `known` has the plans that need no search (null: there is none), by episode, or is empty. `world` must
  /// outlive the object. `processor_clock` is called on the search's thread only.
  OptimumSearch(const World& world, std::vector<uint64_t> seeds, Limits limits,
                std::vector<std::shared_ptr<const Plan>> known = {},
                ProcessorClock processor_clock = ThreadProcessorMicroseconds);
  /// Stops the search.
  ~OptimumSearch();
  OptimumSearch(const OptimumSearch&) = delete;
  OptimumSearch& operator=(const OptimumSearch&) = delete;

  const std::vector<uint64_t>& seeds() const { return seeds_; }

  /// What has been proved so far, by episode.
  std::vector<OptimumBound> bounds() const;

  /// The plans so far, by episode; null if there is none yet.
  std::vector<std::shared_ptr<const Plan>> plans() const;

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
  bool SearchEpisode(size_t episode);
  bool KeepGoing(size_t episode, const PlannerProgress& progress);
  SearchEnd PresentEnd() const;
  void SetLowPriority();

  const World* world_;
  std::vector<uint64_t> seeds_;
  Limits limits_;
  ProcessorClock processor_clock_;
  std::atomic<bool> stop_ = false;
  mutable std::mutex mutex_;
  std::condition_variable ended_changed_;
  double processor_seconds_ = 0;  // taken so far
  double episode_limit_s_ = 0;    // of processor time, for the present episode
  bool hurried_ = false;          // SetFullPriority was called
  int thread_id_ = 0;             // the system's id of the search's thread; 0 before it runs
  bool ended_ = false;
  std::vector<OptimumBound> bounds_;  // by episode
  OptimumResult result_;
  std::thread thread_;
};

}  // namespace fresco
