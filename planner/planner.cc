#include "planner/planner.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "planner/label_search.h"
#include "worlds/uav/baselines.h"
#include "worlds/uav/uav_fields.h"

namespace fresco {
namespace {

constexpr int64_t kFirstWidth = 1000;
constexpr int64_t kWidthFactor = 8;
constexpr int64_t kLeastWidest = 100;

class Planner {
 public:
  Planner(const UavWorld& world, const PlannerOptions& options)
      : world_(world),
        options_(options),
        problem_(world),
        meter_([this](const SearchProgress& progress) { return KeepGoing(progress); }) {}

  Plan Run();

 private:
  bool KeepGoing(const SearchProgress& progress) const;
  void BeginWithBaselines();
  void Search();
  int64_t CostOf(const Episode& flight) const;
  void Use(const LabelSearchResult& result);
  void Conclude();
  double LowerBoundTotalAoi() const;
  double AverageAoi(int64_t cost) const {
    return static_cast<double>(cost) * problem_.average_aoi_per_unit();
  }

  const UavWorld& world_;
  const PlannerOptions& options_;
  PlannerProblem problem_;
  WorkMeter meter_;
  Plan plan_;
  int64_t cost_ = kNoCost;  // cost of plan_.flight
  int64_t proved_ = 0;      // proved so far: no flight costs less
};

bool Planner::KeepGoing(const SearchProgress& progress) const {
  const int64_t bound = std::clamp(progress.least_bound, proved_, cost_);
  return !options_.keep_going || options_.keep_going({progress.width, progress.slot, progress.labels,
                                                      AverageAoi(bound), AverageAoi(cost_)});
}

int64_t Planner::CostOf(const Episode& flight) const {
  int64_t cost = 0;
  for (const UavState& state : StatesIn(flight)) {
    for (size_t n = 0; n < problem_.weights().size(); ++n) {
      cost += problem_.weights()[n] * state.aoi[static_cast<size_t>(problem_.sensors()[n])];
    }
  }
  return cost;
}

void Planner::BeginWithBaselines() {
  for (const BaselineKind kind : {BaselineKind::kAoi, BaselineKind::kDistance}) {
    Episode flight = FlyBaseline(world_, kind);
    FRESCO_CHECK(Arrived(flight));
    if (CostOf(flight) < cost_) {
      cost_ = CostOf(flight);
      plan_.flight = std::move(flight);
    }
  }
}

// Searches in passes of growing width. The first passes are quick and find good flights, and with a good
// flight known the last pass has to follow fewer labels.
void Planner::Search() {
  const LowerBound lower_bound(problem_, options_.memory_bytes * 7 / 8, meter_);
  proved_ = std::min(cost_, lower_bound.OfAnyFlight());
  const CoverageDistances distances(problem_, meter_);
  const int64_t widest =
      std::max(kLeastWidest, (options_.memory_bytes - lower_bound.bytes()) / BytesPerLabel(problem_));
  int64_t width = 0;
  while (proved_ < cost_ && width < widest && !meter_.stopped()) {
    width = std::min(std::max(kFirstWidth, width * kWidthFactor), widest);
    Use(SearchLabels(problem_, lower_bound, distances, cost_, width, meter_));
  }
}

void Planner::Use(const LabelSearchResult& result) {
  plan_.labels += result.labels;
  proved_ = std::max(proved_, result.LowerBound(cost_));
  if (result.cost < cost_) {
    size_t next = 0;
    plan_.flight = Fly(world_, [&](const UavEnvironment&) {
      Action action = result.actions[next++];
      action.schedule =
          action.schedule == 0 ? 0 : problem_.sensors()[static_cast<size_t>(action.schedule) - 1] + 1;
      return action;
    });
    cost_ = result.cost;
    FRESCO_CHECK(Arrived(plan_.flight) && CostOf(plan_.flight) == cost_);
  }
}

void Planner::Conclude() {
  const AoiFigures figures = Figures(world_, plan_.flight);
  plan_.optimal = proved_ >= cost_;
  const bool exact = plan_.optimal && problem_.has_exact_weights();
  plan_.lower_bound_average_aoi =
      exact ? figures.average_aoi : std::min(figures.average_aoi, AverageAoi(proved_));
  plan_.lower_bound_total_aoi = plan_.optimal ? static_cast<double>(figures.total_aoi) : LowerBoundTotalAoi();
}

double Planner::LowerBoundTotalAoi() const {
  if (problem_.has_equal_weights()) {
    const int64_t ignored = world_.sensors() - problem_.size();
    return static_cast<double>(proved_ + ignored * problem_.slots());
  }
  return plan_.lower_bound_average_aoi * problem_.slots() * world_.sensors();
}

Plan Planner::Run() {
  BeginWithBaselines();
  Search();
  Conclude();
  return std::move(plan_);
}

}  // namespace

bool CanPlan(const World& world) {
  return AsUavWorld(world) != nullptr || AsUavFields(world) != nullptr;
}

Plan PlanOptimally(const World& world, uint64_t seed, const PlannerOptions& options) {
  FRESCO_CHECK(CanPlan(world));
  if (const UavFields* fields = AsUavFields(world)) {
    const auto field = fields->WorldOf(seed);
    Plan plan = Planner(*field, options).Run();
    plan.flight = fields->FromItsField(*field, seed, plan.flight);
    return plan;
  }
  return Planner(*AsUavWorld(world), options).Run();
}

}  // namespace fresco
