#include "storage/optimum_search.h"

#include <sched.h>
#include <spdlog/spdlog.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <exception>

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

OptimumSearch::OptimumSearch(const World& world, Limits limits, ProcessorClock processor_clock)
    : world_(&world),
      limits_(limits),
      processor_clock_(std::move(processor_clock)),
      ended_(limits.processor_seconds <= 0 || !CanPlan(world)) {
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
  std::shared_ptr<const Plan> plan;
  try {
    PlannerOptions options;
    options.memory_bytes = limits_.memory_bytes;
    options.keep_going = [this](const PlannerProgress& progress) { return KeepGoing(progress); };
    plan = std::make_shared<const Plan>(PlanOptimally(*world_, options));
  } catch (const std::exception& error) {  // e.g. out of memory; the training continues without the optimum
    spdlog::error("the search for the exact optimum failed: {}", error.what());
  }
  const std::lock_guard lock(mutex_);
  if (plan != nullptr) {
    bound_ = {plan->lower_bound_average_aoi, plan->optimal};
  }
  result_ = {plan, EndOf(plan.get()), static_cast<double>(processor_clock_()) * kSecondsPerMicrosecond};
  ended_ = true;
  ended_changed_.notify_all();
}

SearchEnd OptimumSearch::EndOf(const Plan* plan) const {
  if (plan == nullptr) {
    return SearchEnd::kFailed;
  }
  if (plan->optimal) {
    return SearchEnd::kProved;
  }
  return stop_ && processor_seconds_ < limits_.processor_seconds ? SearchEnd::kStopped : SearchEnd::kLimit;
}

bool OptimumSearch::KeepGoing(const PlannerProgress& progress) {
  const double processor_seconds = static_cast<double>(processor_clock_()) * kSecondsPerMicrosecond;
  const std::lock_guard lock(mutex_);
  processor_seconds_ = processor_seconds;
  if (progress.lower_bound_average > 0) {
    bound_ = {progress.lower_bound_average, false};
  }
  return !stop_ && processor_seconds < limits_.processor_seconds;
}

std::optional<OptimumBound> OptimumSearch::bound() const {
  const std::lock_guard lock(mutex_);
  return bound_;
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
