#include "storage/optimum_search.h"

#include <sched.h>
#include <spdlog/spdlog.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <numeric>

#include "core/error.h"
#include "training/schedules.h"

namespace fresco {

namespace {

constexpr double kSecondsPerMicrosecond = 1e-6;

void SetPolicy(int thread_id, int policy) {
  const sched_param parameters{};
  if (sched_setscheduler(thread_id, policy, &parameters) != 0) {
    spdlog::debug("the system refuses to change the priority of the search for the optimum");
  }
}

}  // namespace

const char* SearchEndName(SearchEnd end) {
  constexpr const char* kNames[] = {"off", "proved", "limit", "stopped", "failed"};
  return kNames[static_cast<size_t>(end)];
}

Gaps GapsOf(std::span<const double> scores, std::span<const double> least_scores) {
  FRESCO_CHECK(!scores.empty() && scores.size() == least_scores.size());
  std::vector<double> gaps;
  for (size_t i = 0; i < scores.size(); ++i) {
    gaps.push_back(GapPercent(scores[i], least_scores[i]));
  }
  std::sort(gaps.begin(), gaps.end());
  const size_t middle = gaps.size() / 2;
  const double median = gaps.size() % 2 == 1 ? gaps[middle] : (gaps[middle - 1] + gaps[middle]) / 2;
  const double sum = std::accumulate(gaps.begin(), gaps.end(), 0.0);
  return {sum / static_cast<double>(gaps.size()), median, gaps.back()};
}

std::vector<uint64_t> EpisodesToPlan(const Experiment& experiment) {
  if (!CanPlan(experiment.world())) {
    return {};
  }
  if (!experiment.world().description().random) {
    return {0};
  }
  if (!experiment.schedule().fixed_evaluation_episodes()) {
    return {};
  }
  std::vector<uint64_t> seeds = FixedEvaluationSeeds(experiment.schedule());
  const std::vector<uint64_t> further = FixedDeliverySeeds(experiment.schedule());
  seeds.insert(seeds.end(), further.begin(), further.end());
  return seeds;
}

OptimumSearch::OptimumSearch(const World& world, std::vector<uint64_t> seeds, Limits limits,
                             std::vector<std::shared_ptr<const Plan>> known, ProcessorClock processor_clock)
    : world_(&world),
      seeds_(std::move(seeds)),
      limits_(limits),
      processor_clock_(std::move(processor_clock)),
      ended_(limits.processor_seconds <= 0 || seeds_.empty() || !CanPlan(world)),
      bounds_(seeds_.size()) {
  result_.plans = std::move(known);
  result_.plans.resize(seeds_.size());
  for (size_t episode = 0; episode < seeds_.size(); ++episode) {
    if (const Plan* plan = result_.plans[episode].get(); plan != nullptr) {
      bounds_[episode] = {plan->lower_bound_average_aoi, plan->optimal};
    }
  }
  if (!ended_) {
    thread_ = std::thread([this] { Search(); });
  }
}

OptimumSearch::~OptimumSearch() {
  Stop();
}

/// Lets the calling thread run only while the threads of training, network and actors need no processor.
void OptimumSearch::SetLowPriority() {
  const std::lock_guard lock(mutex_);
  thread_id_ = static_cast<int>(syscall(SYS_gettid));
  if (!hurried_) {
    SetPolicy(thread_id_, SCHED_IDLE);
  }
}

void OptimumSearch::SetFullPriority() {
  const std::lock_guard lock(mutex_);
  hurried_ = true;
  if (thread_id_ != 0 && !ended_) {  // after a thread has ended, another one may have its id
    SetPolicy(thread_id_, SCHED_OTHER);
  }
}

void OptimumSearch::Search() {
  SetLowPriority();
  bool failed = false;
  for (size_t episode = 0; episode < seeds_.size() && !failed; ++episode) {
    failed = !SearchEpisode(episode);
  }
  const std::lock_guard lock(mutex_);
  result_.end = failed ? SearchEnd::kFailed : PresentEnd();
  result_.processor_seconds = static_cast<double>(processor_clock_()) * kSecondsPerMicrosecond;
  ended_ = true;
  ended_changed_.notify_all();
}

/// Plans an episode that has no plan yet, unless the limit is reached. Returns false if the planner fails.
bool OptimumSearch::SearchEpisode(size_t episode) {
  {
    const std::lock_guard lock(mutex_);
    const double left_s = limits_.processor_seconds - processor_seconds_;
    if (result_.plans[episode] != nullptr || (episode > 0 && (stop_ || left_s <= 0))) {
      return true;
    }
    constexpr double kShare = 0.1;
    const double most_s = seeds_.size() > 1 ? kShare * limits_.processor_seconds : left_s;
    episode_limit_s_ = processor_seconds_ + std::min(left_s, most_s);
  }
  std::shared_ptr<const Plan> plan;
  try {
    PlannerOptions options;
    options.memory_bytes = limits_.memory_bytes;
    options.keep_going = [=, this](const PlannerProgress& progress) { return KeepGoing(episode, progress); };
    plan = std::make_shared<const Plan>(PlanOptimally(*world_, seeds_[episode], options));
  } catch (const std::exception& error) {  // e.g. out of memory; the training continues without the optimum
    spdlog::error("the search for the exact optimum failed: {}", error.what());
    return false;
  }
  const std::lock_guard lock(mutex_);
  bounds_[episode] = {plan->lower_bound_average_aoi, plan->optimal};
  result_.plans[episode] = plan;
  return true;
}

SearchEnd OptimumSearch::PresentEnd() const {
  if (std::all_of(bounds_.begin(), bounds_.end(), [](const OptimumBound& bound) { return bound.proved; })) {
    return SearchEnd::kProved;
  }
  return stop_ && processor_seconds_ < limits_.processor_seconds ? SearchEnd::kStopped : SearchEnd::kLimit;
}

bool OptimumSearch::KeepGoing(size_t episode, const PlannerProgress& progress) {
  const double processor_seconds = static_cast<double>(processor_clock_()) * kSecondsPerMicrosecond;
  const std::lock_guard lock(mutex_);
  processor_seconds_ = processor_seconds;
  bounds_[episode].lower_bound_average_aoi = progress.lower_bound_average;
  return !stop_ && processor_seconds < episode_limit_s_;
}

std::vector<OptimumBound> OptimumSearch::bounds() const {
  const std::lock_guard lock(mutex_);
  return bounds_;
}

std::vector<std::shared_ptr<const Plan>> OptimumSearch::plans() const {
  const std::lock_guard lock(mutex_);
  return result_.plans;
}

double OptimumSearch::processor_seconds_left() const {
  const std::lock_guard lock(mutex_);
  return ended_ ? 0 : std::max(0.0, limits_.processor_seconds - processor_seconds_);
}

bool OptimumSearch::WaitForEnd(int64_t timeout_us) {
  std::unique_lock lock(mutex_);
  return ended_changed_.wait_for(lock, std::chrono::microseconds(timeout_us), [this] { return ended_; });
}

void OptimumSearch::Stop() {
  stop_ = true;
  SetFullPriority();
  if (thread_.joinable()) {
    thread_.join();
  }
}

OptimumResult OptimumSearch::result() const {
  const std::lock_guard lock(mutex_);
  return result_;
}

}  // namespace fresco
