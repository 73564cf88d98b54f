#include "tests/training/literal_flight.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fresco {

Doubles LiteralValues(const Experiment& experiment, const Vector& parameters, const UavState& state) {
  const Scenario& scenario = RequireUavWorld(experiment.world(), "the test").scenario();
  Doubles input = {state.cell.column / (scenario.columns - 1.0), state.cell.row / (scenario.rows - 1.0)};
  for (const int16_t aoi : state.aoi) {
    input.push_back(static_cast<double>(aoi) / scenario.slots);
  }
  input.push_back(static_cast<double>(state.time_margin) / scenario.slots);
  input.push_back(static_cast<double>(state.energy_margin_j) / scenario.initial_energy_j);
  if (experiment.agent().sensor_geometry()) {
    Doubles distances_m;
    for (const Sensor& sensor : scenario.sensors) {
      const double east_m = sensor.x_m - state.cell.column * scenario.cell_m;
      const double north_m = sensor.y_m - state.cell.row * scenario.cell_m;
      distances_m.push_back(std::sqrt(east_m * east_m + north_m * north_m));
    }
    for (const double distance_m : distances_m) {
      input.push_back(distance_m <= scenario.coverage_radius_m ? 1 : 0);
    }
    for (const double distance_m : distances_m) {
      input.push_back(distance_m / (std::max(scenario.columns, scenario.rows) * scenario.cell_m));
    }
  }
  const Doubles wide(parameters.data(), parameters.data() + parameters.size());
  return LiteralForward(experiment.network()->layer_sizes(), wide, input);
}

int LiteralArgmax(const Doubles& values, const Mask& mask) {
  int best = -1;
  for (size_t action = 0; action < values.size(); ++action) {
    if (mask[action] != 0 && (best < 0 || values[action] > values[static_cast<size_t>(best)])) {
      best = static_cast<int>(action);
    }
  }
  return best;
}

double Lead(const Doubles& values, const Mask& mask) {
  Doubles allowed;
  for (size_t action = 0; action < values.size(); ++action) {
    if (mask[action] != 0) {
      allowed.push_back(values[action]);
    }
  }
  std::sort(allowed.rbegin(), allowed.rend());
  return allowed.size() < 2 ? std::numeric_limits<double>::infinity() : allowed[0] - allowed[1];
}

std::vector<Mask> MasksOf(const Experiment& experiment, const Episode& episode) {
  const UavWorld& world = RequireUavWorld(experiment.world(), "the test");
  UavEnvironment environment(world);
  environment.Reset();
  Mask mask(static_cast<size_t>(world.actions()));
  std::vector<Mask> masks;
  for (const int16_t action : episode.actions) {
    environment.WriteMask(mask);
    masks.push_back(mask);
    environment.Step(world.ActionAt(action));
  }
  environment.WriteMask(mask);
  masks.push_back(mask);
  return masks;
}

double LiteralTdError(const Experiment& experiment, const FlightPlan& plan, const Episode& episode,
                      int transition, const Mask& next_mask) {
  const auto i = static_cast<size_t>(transition);
  const Doubles values = LiteralValues(experiment, *plan.current, StateIn(episode, i));
  double y = episode.rewards[i];
  if (transition + 1 < episode.transitions()) {
    const UavState next = StateIn(episode, i + 1);
    const Doubles target_values = LiteralValues(experiment, *plan.target, next);
    const Doubles choosing =
        experiment.agent().double_dqn() ? LiteralValues(experiment, *plan.current, next) : target_values;
    const int best = LiteralArgmax(choosing, next_mask);
    y += experiment.agent().discount() * target_values[static_cast<size_t>(best)];
  }
  return y - values[static_cast<size_t>(episode.actions[i])];
}

}  // namespace fresco
