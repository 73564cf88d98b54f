#include "worlds/uav/baselines.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/error.h"

namespace fresco {
namespace {

// Returns the sensor with the largest AoI among those for which `eligible(sensor)` is true; of equal ones the
// lowest index; -1 if there is none.
template <typename Eligible>
int Oldest(const UavState& state, const Eligible& eligible) {
  int oldest = -1;
  int largest_aoi = 0;
  for (int sensor = 0; sensor < static_cast<int>(state.aoi.size()); ++sensor) {
    const int aoi = state.aoi[static_cast<size_t>(sensor)];
    if (aoi > largest_aoi && eligible(sensor)) {
      oldest = sensor;
      largest_aoi = aoi;
    }
  }
  return oldest;
}

// The sensor with the largest AoI once `served_now` (-1: none) has transmitted in this slot.
int OldestAfter(const UavState& state, int served_now) {
  const int oldest = Oldest(state, [=](int sensor) { return sensor != served_now; });
  return oldest >= 0 ? oldest : served_now;
}

/// The cell to aim at for a sensor: the nearest one. With a map, only cells count that flights lead to, and
/// of these those that cover the sensor, if there are any; of equal ones, the first by CellIndex.
Cell GoalOf(const UavWorld& world, int number) {
  const Scenario& scenario = world.scenario();
  const Sensor& sensor = scenario.sensors[static_cast<size_t>(number)];
  if (world.map() == nullptr) {
    return CellOf(sensor, scenario.cell_m, scenario.columns, scenario.rows);
  }
  Cell goal = scenario.stop;
  bool covers = false;
  double smallest_m = std::numeric_limits<double>::infinity();
  for (const Cell cell : world.map()->CellsAround(scenario.start)) {
    const bool better = world.Covers(cell, number);
    const double distance_m = HorizontalDistance(cell, scenario.cell_m, sensor);
    if (better > covers || (better == covers && distance_m < smallest_m)) {
      goal = cell;
      covers = better;
      smallest_m = distance_m;
    }
  }
  return goal;
}

// Flies to the stop. Once there, hovers if the energy allows it, and otherwise flies to and fro.
Move MoveHome(const UavWorld& world, const UavEnvironment& environment) {
  const Move direct = MoveTowards(world.map(), environment.state().cell, world.scenario().stop);
  if (environment.IsSafe(direct)) {
    return direct;
  }
  for (const Move move : {Move::kNorth, Move::kSouth, Move::kEast, Move::kWest}) {
    if (environment.IsSafe(move)) {
      return move;
    }
  }
  return direct;  // no move is safe: the stop was out of reach already
}

}  // namespace

Baseline::Baseline(BaselineKind kind, const UavWorld& world) : kind_(kind), world_(&world) {
  for (int sensor = 0; sensor < world.sensors(); ++sensor) {
    goals_.push_back(GoalOf(world, sensor));
  }
  Reset();
}

void Baseline::Reset() {
  served_.assign(static_cast<size_t>(world_->sensors()), 0);
  returning_ = false;
}

Action Baseline::Choose(const UavEnvironment& environment) {
  const UavState& state = environment.state();
  const int served_now = Oldest(state, [&](int sensor) { return world_->Covers(state.cell, sensor); });
  const int target =
      kind_ == BaselineKind::kAoi ? OldestAfter(state, served_now) : NextOfRound(state.cell, served_now);
  const Move wanted = MoveTowards(world_->map(), state.cell, goals_[static_cast<size_t>(target)]);
  returning_ = returning_ || !environment.IsSafe(wanted);
  return {returning_ ? MoveHome(*world_, environment) : wanted, served_now + 1};
}

int Baseline::NextOfRound(Cell cell, int served_now) {
  if (served_now >= 0) {
    served_[static_cast<size_t>(served_now)] = 1;  // it transmits before the UAV moves
  }
  if (std::count(served_.begin(), served_.end(), 0) == 0) {
    std::fill(served_.begin(), served_.end(), uint8_t{0});
  }
  const Scenario& scenario = world_->scenario();
  int nearest = -1;
  std::pair<int, double> smallest = {std::numeric_limits<int>::max(), 0};  // moves, metres
  for (int index = 0; index < world_->sensors(); ++index) {
    const Sensor& sensor = scenario.sensors[static_cast<size_t>(index)];
    const int moves =
        world_->map() == nullptr ? 0 : world_->map()->Distance(cell, goals_[static_cast<size_t>(index)]);
    const std::pair distance = {moves, HorizontalDistance(cell, scenario.cell_m, sensor)};
    if (served_[static_cast<size_t>(index)] == 0 && distance < smallest) {
      nearest = index;
      smallest = distance;
    }
  }
  return nearest;
}

Episode FlyBaseline(const UavWorld& world, BaselineKind kind) {
  Baseline baseline(kind, world);
  return Fly(world, [&](const UavEnvironment& environment) { return baseline.Choose(environment); });
}

}  // namespace fresco
