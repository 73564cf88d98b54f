#include "msgs/flight_messages.h"

#include <algorithm>
#include <numeric>
#include <span>

namespace fresco {
namespace {

static_assert(kMaximumSensors == flight_t::MAXIMUM_SENSOR_COUNT);

/// A message with everything but the sensors.
scenario_t FieldOf(const Scenario& scenario) {
  scenario_t message{};
  message.total_sensors = static_cast<int32_t>(scenario.sensors.size());
  message.columns = scenario.columns;
  message.rows = scenario.rows;
  message.cell_m = scenario.cell_m;
  message.start_column = scenario.start.column;
  message.start_row = scenario.start.row;
  message.stop_column = scenario.stop.column;
  message.stop_row = scenario.stop.row;
  message.slots = scenario.slots;
  message.slot_s = scenario.slot_s;
  message.coverage_radius_m = scenario.coverage_radius_m;
  message.initial_energy_j = scenario.initial_energy_j;
  message.maximum_aoi = scenario.maximum_aoi.value_or(0);
  return message;
}

void SetSensors(std::span<const Sensor> sensors, scenario_t& message) {
  message.sensor_count = static_cast<int32_t>(sensors.size());
  for (const Sensor& sensor : sensors) {
    message.x_m.push_back(sensor.x_m);
    message.y_m.push_back(sensor.y_m);
    message.weight.push_back(sensor.weight);
  }
}

void SetState(const UavWorld& world, const UavState& state, flight_t& message) {
  message.slot = state.slot;
  message.slots = world.scenario().slots;
  message.column = static_cast<int16_t>(state.cell.column);
  message.row = static_cast<int16_t>(state.cell.row);
  message.time_margin = static_cast<int16_t>(state.time_margin);
  message.energy_margin_j = state.energy_margin_j;
  message.sensor_count = world.sensors();
  message.aoi = state.aoi;
  message.total_aoi += std::accumulate(state.aoi.begin(), state.aoi.end(), int64_t{0});
}

}  // namespace

std::vector<scenario_t> ScenarioMessages(const UavWorld& world) {
  std::vector<scenario_t> messages;
  const Scenario& scenario = world.scenario();
  const std::span<const Sensor> sensors = scenario.sensors;
  for (size_t first = 0; first < sensors.size(); first += kMaximumSensorsPerScenario) {
    scenario_t message = FieldOf(scenario);
    message.first_sensor = static_cast<int32_t>(first);
    SetSensors(sensors.subspan(first, std::min<size_t>(kMaximumSensorsPerScenario, sensors.size() - first)),
               message);
    messages.push_back(std::move(message));
  }
  return messages;
}

std::vector<flight_t> FlightMessages(const UavWorld& world, const Episode& flight,
                                     const std::string& policy) {
  std::vector<flight_t> messages;
  flight_t message{};
  message.policy = policy.substr(0, kMaximumPolicyBytes);
  for (size_t slot = 0; slot <= flight.actions.size(); ++slot) {
    const bool last = slot == flight.actions.size();
    const Action action = ActionIn(world, flight, slot);
    SetState(world, StateIn(flight, slot), message);
    message.remaining_energy_j = static_cast<float>(EnergyIn(world, flight, slot));
    message.outcome = static_cast<int8_t>(last ? OutcomeOf(flight) : Outcome::kFlying);
    message.move = static_cast<int8_t>(action.move);
    message.scheduled = static_cast<int16_t>(action.schedule);
    message.reward = last ? 0.0f : flight.rewards[slot];
    messages.push_back(message);
  }
  return messages;
}

}  // namespace fresco
