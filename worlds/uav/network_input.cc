#include "worlds/uav/network_input.h"

#include <algorithm>
#include <array>

#include "core/error.h"
#include "worlds/uav/flight.h"

namespace fresco {
namespace {

float Share(int position, int cells) {
  return cells > 1 ? static_cast<float>(position) / static_cast<float>(cells - 1) : 0.0f;
}

constexpr int kOwnInputs = 6;     // of an input for sets
constexpr int kSensorInputs = 7;  // of each sensor

/// The grid's longer side.
double Side(const Scenario& scenario) {
  return std::max(scenario.columns, scenario.rows) * scenario.cell_m;
}

/// The horizontal distance, divided by the grid's longer side.
float ScaledDistance(const Scenario& scenario, Cell cell, const Sensor& sensor) {
  return static_cast<float>(HorizontalDistance(cell, scenario.cell_m, sensor) / Side(scenario));
}

/// The length of the way to the sensor, as MapInput has it.
float WayTo(const MapInput& map_input, Cell cell, const Scenario& scenario, const Sensor& sensor) {
  std::array<float, MapInput::kInputs> way{};
  if (scenario.map->MayFly(cell)) {
    map_input.WriteWayToSensor(cell, sensor, scenario.coverage_radius_m, way);
  }
  return way[0];
}

}  // namespace

NetworkInput::NetworkInput(const UavWorld& world, NetworkInputOptions options)
    : world_(&world), options_(options) {
  const Scenario& scenario = world.scenario();
  if (world.map() != nullptr && (options.sets || options.sensor_geometry)) {
    map_input_.emplace(*world.map(), scenario.cell_m, scenario.coverage_radius_m);
  }
  if (!options.sensor_geometry || options.sets) {
    return;
  }
  geometry_.reserve(static_cast<size_t>(scenario.columns) * static_cast<size_t>(scenario.rows) * 2 *
                    scenario.sensors.size());
  for (int row = 0; row < scenario.rows; ++row) {
    for (int column = 0; column < scenario.columns; ++column) {
      for (int sensor = 0; sensor < world.sensors(); ++sensor) {
        geometry_.push_back(world.Covers({column, row}, sensor) ? 1.0f : 0.0f);
      }
      for (const Sensor& sensor : scenario.sensors) {
        geometry_.push_back(map_input_ ? WayTo(*map_input_, {column, row}, scenario, sensor)
                                       : ScaledDistance(scenario, {column, row}, sensor));
      }
    }
  }
}

int NetworkInput::Size(int sensors, NetworkInputOptions options, bool has_map) {
  if (const std::optional<ObservationSets> sets = Sets(sensors, options, has_map)) {
    return sets->own_inputs + sensors * sets->item_inputs;
  }
  return sensors + 4 + (options.sensor_geometry ? 2 * sensors : 0);
}

std::optional<ObservationSets> NetworkInput::Sets(int sensors, NetworkInputOptions options, bool has_map) {
  if (!options.sets) {
    return std::nullopt;
  }
  const int of_map = has_map ? static_cast<int>(MapInput::kInputs) : 0;
  return ObservationSets{kOwnInputs + of_map, sensors, kSensorInputs + of_map, kMoves};
}

void NetworkInput::WriteSets(std::span<const float> state, std::span<float> input) const {
  const Scenario& scenario = world_->scenario();
  const double side_m = Side(scenario);
  const auto slots = static_cast<float>(scenario.slots);
  const Cell cell = CellIn(state);
  const auto scaled = [&](double metres) { return static_cast<float>(metres / side_m); };
  size_t next = 0;
  input[next++] = Share(cell.column, scenario.columns);
  input[next++] = Share(cell.row, scenario.rows);
  input[next++] = scaled((scenario.stop.column - cell.column) * scenario.cell_m);
  input[next++] = scaled((scenario.stop.row - cell.row) * scenario.cell_m);
  input[next++] = state[kTimeMarginField] / slots;
  input[next++] = state[kEnergyMarginField] / static_cast<float>(scenario.initial_energy_j);
  if (map_input_) {
    map_input_->WriteWayToStop(cell, scenario.stop, input.subspan(next));
    next += MapInput::kInputs;
  }
  for (int i = 0; i < world_->sensors(); ++i) {
    const auto at = static_cast<size_t>(i);
    const Sensor& sensor = scenario.sensors[at];
    input[next++] = 1;
    input[next++] = scaled(sensor.x_m - cell.column * scenario.cell_m);
    input[next++] = scaled(sensor.y_m - cell.row * scenario.cell_m);
    input[next++] = ScaledDistance(scenario, cell, sensor);
    input[next++] = world_->Covers(cell, i) ? 1 : 0;
    input[next++] = state[kAoiField + at] / slots;
    input[next++] = static_cast<float>(world_->sensors() * world_->theta()[at]);
    if (map_input_) {
      map_input_->WriteWayToSensor(cell, sensor, scenario.coverage_radius_m, input.subspan(next));
      next += MapInput::kInputs;
    }
  }
}

void NetworkInput::Write(std::span<const float> state, std::span<float> input) const {
  const auto sensors = static_cast<size_t>(world_->sensors());
  FRESCO_CHECK(input.size() ==
               static_cast<size_t>(Size(world_->sensors(), options_, world_->map() != nullptr)));
  FRESCO_CHECK(state.size() == kAoiField + sensors);
  if (options_.sets) {
    WriteSets(state, input);
    return;
  }
  const Scenario& scenario = world_->scenario();
  const auto slots = static_cast<float>(scenario.slots);
  const Cell cell = CellIn(state);
  size_t next = 0;
  input[next++] = Share(cell.column, scenario.columns);
  input[next++] = Share(cell.row, scenario.rows);
  for (const float aoi : state.subspan(kAoiField)) {
    input[next++] = aoi / slots;
  }
  input[next++] = state[kTimeMarginField] / slots;
  input[next++] = state[kEnergyMarginField] / static_cast<float>(scenario.initial_energy_j);
  if (options_.sensor_geometry) {
    const auto entries = static_cast<int64_t>(2 * sensors);
    std::copy_n(geometry_.begin() + world_->CellIndex(cell) * entries, entries,
                input.begin() + static_cast<int64_t>(next));
  }
}

}  // namespace fresco
