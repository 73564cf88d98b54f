#include "planner/planner_problem.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

namespace fresco {
namespace {

// The largest weight with which a flight's cost stays below 2^50. Sums of a few such numbers are exact in a
// double.
double LargestWholeWeight(int sensors, int slots) {
  return std::floor(std::ldexp(1.0, 50) / (sensors * (slots * (slots + 1.0) / 2)));
}

// Whether all products are whole numbers, with a tolerance for the rounding of decimal fractions, of a
// division and of a product in double.
bool AllWhole(const std::vector<double>& weights, double factor) {
  constexpr double kTolerance = 4e-15;
  return std::all_of(weights.begin(), weights.end(), [&](double weight) {
    return std::abs(weight * factor - std::round(weight * factor)) <= kTolerance * weight * factor;
  });
}

// Returns a factor that makes all weights whole numbers of at most `limit`; 0 if none is found.
double WholeFactor(const std::vector<double>& weights, double limit) {
  constexpr int kMostParts = 100000;
  const auto [smallest, largest] = std::minmax_element(weights.begin(), weights.end());
  // If they are multiples of a common fraction, the smallest weight is a multiple of it, too.
  for (int parts = 1; parts <= kMostParts && *largest / *smallest * parts <= limit; ++parts) {
    if (AllWhole(weights, parts / *smallest)) {
      return parts / *smallest;
    }
  }
  return 0;
}

}  // namespace

PlannerProblem::PlannerProblem(const UavWorld& world)
    : world_(&world),
      maximum_aoi_(std::min(world.scenario().maximum_aoi.value_or(slots()), slots())),
      hovering_is_dearer_(world.hovering_energy_j() >= world.flying_energy_j()) {
  ScaleWeights();
  ComputeEnergies();
  TabulateMoves();
}

void PlannerProblem::ScaleWeights() {
  std::vector<double> weights;
  for (int sensor = 0; sensor < world_->sensors(); ++sensor) {
    const double weight = world_->scenario().sensors[static_cast<size_t>(sensor)].weight;
    if (weight > 0) {
      sensors_.push_back(sensor);
      weights.push_back(weight);
    }
  }
  const double limit = LargestWholeWeight(size(), slots());
  double factor = WholeFactor(weights, limit);
  has_exact_weights_ = factor > 0;
  if (!has_exact_weights_) {
    factor = limit / *std::max_element(weights.begin(), weights.end());
  }
  for (const double weight : weights) {
    const double scaled = weight * factor;
    weights_.push_back(static_cast<int64_t>(has_exact_weights_ ? std::round(scaled) : std::floor(scaled)));
  }
  const double weight_sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  average_aoi_per_unit_ = 1 / (factor * weight_sum * slots());
}

bool PlannerProblem::has_equal_weights() const {
  return std::all_of(weights_.begin(), weights_.end(), [&](int64_t weight) { return weight == 1; });
}

void PlannerProblem::ComputeEnergies() {
  cheap_energy_j_ = std::min(world_->hovering_energy_j(), world_->flying_energy_j());
  extra_energy_j_ = std::abs(world_->hovering_energy_j() - world_->flying_energy_j());
  const int moves = slots() - 1;
  const double budget_j = world_->scenario().initial_energy_j - moves * cheap_energy_j_;
  energy_binds_ = budget_j < moves * extra_energy_j_;
  dear_slots_ = moves;
  while (dear_slots_ * extra_energy_j_ > budget_j) {  // exact, since UavWorld rounds its energies
    --dear_slots_;
  }
}

void PlannerProblem::TabulateMoves() {
  after_.assign(static_cast<size_t>(cells()) * kMoves, -1);
  for (int cell = 0; cell < cells(); ++cell) {
    for (const Move move : kAllMoves) {
      const Cell to = world_->After(CellAt(cell), move);
      if (move == Move::kHover || to != CellAt(cell)) {
        after_[static_cast<size_t>(cell) * kMoves + static_cast<size_t>(move)] = world_->CellIndex(to);
      }
    }
  }
}

int PlannerProblem::DearAllowance(int slot, int cell) const {
  const Scenario& scenario = world_->scenario();
  const Cell at = CellAt(cell);
  const int from_start = world_->Distance(scenario.start, at);
  const int slots_left = slots() - slot;
  if (from_start > slot - 1 || world_->DistanceToStop(at) > slots_left) {
    return -1;
  }
  if (!energy_binds_) {
    return dear_slots_;
  }
  // The energy of the way to the stop says how many dear slots it needs.
  const double home_j =
      CompletionEnergy(*world_, world_->DistanceToStop(at), slots_left) - slots_left * cheap_energy_j_;
  return dear_slots_ - static_cast<int>(std::lround(home_j / extra_energy_j_));
}

}  // namespace fresco
