#include "uav/planner.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "uav/label_search.h"

namespace fresco {
namespace {

constexpr int64_t kFirstWidth = 1000;
constexpr int64_t kWidthFactor = 8;

class Planner {
 public:
  Planner(const World& world, const PlannerOptions& options)
      : world_(world),
        options_(options),
        problem_(world),
        lower_bound_(problem_, options.memory_bytes * 7 / 8) {}

  Plan Run();

 private:
  void BeginWithBaselines();
  int64_t CostOf(const Flight& flight) const;
  void Take(const LabelSearchResult& result);
  double AverageAoi(int64_t cost) const { return static_cast<double>(cost) * problem_.average_aoi_per_unit(); }

  const World& world_;
  const PlannerOptions& options_;
  PlannerProblem problem_;
  LowerBound lower_bound_;
  Plan plan_;
  int64_t cost_ = kNoCost;
  int64_t proved_ = 0;
};

int64_t Planner::CostOf(const Flight& flight) const {
  int64_t cost = 0;
  for (const FlightSlot& slot : flight.slots) {
    for (int n = 0; n < problem_.size(); ++n) {
      const auto i = static_cast<size_t>(n);
      cost += int64_t{problem_.weights()[i]} * slot.state.aoi[static_cast<size_t>(problem_.sensors()[i])];
    }
  }
  return cost;
}

void Planner::BeginWithBaselines() {
  for (const BaselineKind kind : {BaselineKind::kAoi, BaselineKind::kDistance}) {
    Flight flight = FlyBaseline(world_, kind);
    if (flight.arrived() && CostOf(flight) < cost_) {
      cost_ = CostOf(flight);
      plan_.flight = std::move(flight);
    }
  }
}

void Planner::Take(const LabelSearchResult& result) {
  plan_.labels += result.labels;
  proved_ = std::max(proved_, result.LowerBound(cost_));
  if (result.cost < cost_) {
    size_t next = 0;
    plan_.flight = Fly(world_, [&](const Environment&) {
      Action action = result.actions[next++];
      action.schedule = action.schedule == 0
                            ? 0
                            : problem_.sensors()[static_cast<size_t>(action.schedule) - 1] + 1;
      return action;
    });
    cost_ = result.cost;
    FRESCO_CHECK(plan_.flight.arrived() && CostOf(plan_.flight) == cost_);
  }
}

Plan Planner::Run() {
  BeginWithBaselines();
  const int64_t widest =
      std::max(kFirstWidth, (options_.memory_bytes - lower_bound_.bytes()) / BytesPerLabel(problem_));
  bool stopped = false;
  for (int64_t width = kFirstWidth; proved_ < cost_ && !stopped; width *= kWidthFactor) {
    const int64_t pass_width = std::min(width, widest);
    const auto keep_going = [&](int slot, int64_t labels, int64_t least_bound) {
      const int64_t bound = std::clamp(least_bound, proved_, cost_);
      return !options_.keep_going ||
             options_.keep_going({pass_width, slot, labels, AverageAoi(bound), AverageAoi(cost_)});
    };
    const LabelSearchResult result = SearchLabels(problem_, lower_bound_, cost_, pass_width, keep_going);
    Take(result);
    stopped = result.stopped || pass_width == widest;
  }
  const AoiFigures figures = Figures(world_, plan_.flight);
  plan_.optimal = proved_ >= cost_;
  plan_.lower_bound_average_aoi = std::min(figures.average_aoi, AverageAoi(proved_));
  if (plan_.optimal) {
    plan_.lower_bound_average_aoi = figures.average_aoi;
  }
  plan_.lower_bound_total_aoi = plan_.lower_bound_average_aoi * world_.scenario().slots * world_.sensors();
  return plan_;
}

}  // namespace

Plan PlanOptimally(const World& world, const PlannerOptions& options) {
  return Planner(world, options).Run();
}

}  // namespace fresco
