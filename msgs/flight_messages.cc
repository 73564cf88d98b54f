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

/// The kinds of a map's cells, by UavWorld::CellIndex; empty if there is no map.
std::vector<uint8_t> CellKinds(const UavWorld& world) {
  std::vector<uint8_t> kinds;
  for (int row = 0; world.map() != nullptr && row < world.map()->rows(); ++row) {
    for (int column = 0; column < world.map()->columns(); ++column) {
      kinds.push_back(static_cast<uint8_t>(world.map()->KindOf({column, row})));
    }
  }
  return kinds;
}

/// The part `number` of values that are cut into parts of `size`; empty behind the last part.
template <class Value>
std::span<const Value> PartOf(std::span<const Value> values, size_t number, size_t size) {
  const size_t first = std::min(number * size, values.size());
  return values.subspan(first, std::min(size, values.size() - first));
}

void SetSensors(std::span<const Sensor> all, size_t number, scenario_t& message) {
  const std::span<const Sensor> sensors = PartOf(all, number, kMaximumSensorsPerScenario);
  message.sensor_count = static_cast<int32_t>(sensors.size());
  message.first_sensor = static_cast<int32_t>(sensors.data() - all.data());
  for (const Sensor& sensor : sensors) {
    message.x_m.push_back(sensor.x_m);
    message.y_m.push_back(sensor.y_m);
    message.weight.push_back(sensor.weight);
  }
}

void SetCells(std::span<const uint8_t> all, size_t number, scenario_t& message) {
  const std::span<const uint8_t> kinds = PartOf(all, number, kMaximumCellsPerScenario);
  message.cell_count = static_cast<int32_t>(kinds.size());
  message.first_cell = static_cast<int32_t>(kinds.data() - all.data());
  message.total_cells = static_cast<int32_t>(all.size());
  message.cell_kind.assign(kinds.begin(), kinds.end());
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
  const std::vector<uint8_t> kinds = CellKinds(world);
  do {
    scenario_t message = FieldOf(scenario);
    SetSensors(sensors, messages.size(), message);
    SetCells(kinds, messages.size(), message);
    messages.push_back(std::move(message));
  } while (messages.size() * kMaximumSensorsPerScenario < sensors.size() ||
           messages.size() * kMaximumCellsPerScenario < kinds.size());
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
