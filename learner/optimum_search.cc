#include "learner/optimum_search.h"

#include <spdlog/spdlog.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <exception>

#include "core/clock.h"

namespace fresco {
namespace {

/// The calling thread only: what trains and what talks goes first.
void TakeWhatIsLeftOfTheProcessor() {
  constexpr int kLeastUrgent = 19;
  setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kLeastUrgent);
}

}  // namespace

OptimumSearch::OptimumSearch(const World& world, Limits limits)
    : world_(&world), limits_(limits), begin_us_(MonotonicMicroseconds()), ended_(limits.seconds <= 0) {
  if (!ended_) {
    thread_ = std::thread([this] { Search(); });
  }
}

OptimumSearch::~OptimumSearch() {
  Stop();
}

void OptimumSearch::Search() {
  TakeWhatIsLeftOfTheProcessor();
  std::shared_ptr<const Plan> plan;
  try {
    PlannerOptions options;
    options.memory_bytes = limits_.memory_bytes;
    options.keep_going = [this](const PlannerProgress& progress) { return KeepGoing(progress); };
    plan = std::make_shared<const Plan>(PlanOptimally(*world_, options));
  } catch (const std::exception& error) {  // out of memory, say: the training goes on without
    spdlog::error("the search for the exact optimum failed: {}", error.what());
  }
  const std::lock_guard lock(mutex_);
  if (plan != nullptr) {
    bound_ = {plan->lower_bound_average_aoi, plan->optimal};
  }
  plan_ = std::move(plan);
  ended_ = true;
  ended_changed_.notify_all();
}

bool OptimumSearch::KeepGoing(const PlannerProgress& progress) {
  const std::lock_guard lock(mutex_);
  if (progress.lower_bound_average > 0) {
    bound_ = {progress.lower_bound_average, false};
  }
  return !stop_ && static_cast<double>(MonotonicMicroseconds() - begin_us_) * 1e-6 < limits_.seconds;
}

std::optional<OptimumBound> OptimumSearch::bound() const {
  const std::lock_guard lock(mutex_);
  return bound_;
}

double OptimumSearch::seconds_left() const {
  const std::lock_guard lock(mutex_);
  const double passed_s = static_cast<double>(MonotonicMicroseconds() - begin_us_) * 1e-6;
  return ended_ ? 0 : std::max(0.0, limits_.seconds - passed_s);
}

bool OptimumSearch::WaitForEnd(int64_t timeout_us) {
  std::unique_lock lock(mutex_);
  return ended_changed_.wait_for(lock, std::chrono::microseconds(timeout_us), [this] { return ended_; });
}

void OptimumSearch::Stop() {
  stop_ = true;
  if (thread_.joinable()) {
    thread_.join();
  }
}

std::shared_ptr<const Plan> OptimumSearch::plan() const {
  const std::lock_guard lock(mutex_);
  return plan_;
}

}  // namespace fresco
