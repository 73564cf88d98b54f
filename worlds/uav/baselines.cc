#include "worlds/uav/baselines.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

// Returns the index of the nearest cell along one axis; half-way between two cells, the lower one.
int NearestIndex(double position_m, double cell_m, int cells) {
  const double index = std::ceil(position_m / cell_m - 0.5);
  return static_cast<int>(std::clamp(index, 0.0, cells - 1.0));
}

Cell NearestCell(const Scenario& scenario, const Sensor& sensor) {
  return {NearestIndex(sensor.x_m, scenario.cell_m, scenario.columns),
          NearestIndex(sensor.y_m, scenario.cell_m, scenario.rows)};
}

// Flies to the stop. Once there, hovers if the energy allows it, and otherwise flies to and fro.
Move MoveHome(const UavEnvironment& environment, Cell stop) {
  const Move direct = MoveTowards(environment.state().cell, stop);
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
  Reset();
}

void Baseline::Reset() {
  served_.assign(static_cast<size_t>(world_->sensors()), 0);
  returning_ = false;
}

Action Baseline::Choose(const UavEnvironment& environment) {
  const UavState& state = environment.state();
  const Scenario& scenario = world_->scenario();
  const int served_now = Oldest(state, [&](int sensor) { return world_->Covers(state.cell, sensor); });
  const int target =
      kind_ == BaselineKind::kAoi ? OldestAfter(state, served_now) : NextOfRound(state.cell, served_now);
  const Cell goal = NearestCell(scenario, scenario.sensors[static_cast<size_t>(target)]);
  const Move wanted = MoveTowards(state.cell, goal);
  returning_ = returning_ || !environment.IsSafe(wanted);
  return {returning_ ? MoveHome(environment, scenario.stop) : wanted, served_now + 1};
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
  double smallest_m = std::numeric_limits<double>::infinity();
  for (int index = 0; index < world_->sensors(); ++index) {
    const Sensor& sensor = scenario.sensors[static_cast<size_t>(index)];
    const double distance_m = HorizontalDistance(cell, scenario.cell_m, sensor);
    if (served_[static_cast<size_t>(index)] == 0 && distance_m < smallest_m) {
      nearest = index;
      smallest_m = distance_m;
    }
  }
  return nearest;
}

Episode FlyBaseline(const UavWorld& world, BaselineKind kind) {
  Baseline baseline(kind, world);
  return Fly(world, [&](const UavEnvironment& environment) { return baseline.Choose(environment); });
}

}  // namespace fresco
