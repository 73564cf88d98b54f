#include "worlds/uav/network_input.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace fresco {
namespace {

float Share(int position, int cells) {
  return cells > 1 ? static_cast<float>(position) / static_cast<float>(cells - 1) : 0.0f;
}

/// The horizontal distance, divided by the grid's longer side.
float ScaledDistance(const Scenario& scenario, Cell cell, const Sensor& sensor) {
  const double distance_m =
      std::hypot(cell.column * scenario.cell_m - sensor.x_m, cell.row * scenario.cell_m - sensor.y_m);
  return static_cast<float>(distance_m / (std::max(scenario.columns, scenario.rows) * scenario.cell_m));
}

}  // namespace

NetworkInput::NetworkInput(const World& world, NetworkInputOptions options)
    : world_(&world), options_(options) {
  if (!options.sensor_geometry) {
    return;
  }
  const Scenario& scenario = world.scenario();
  geometry_.reserve(static_cast<size_t>(BytesFor(world, options)) / sizeof(geometry_[0]));
  for (int row = 0; row < scenario.rows; ++row) {
    for (int column = 0; column < scenario.columns; ++column) {
      for (int sensor = 0; sensor < world.sensors(); ++sensor) {
        geometry_.push_back(world.Covers({column, row}, sensor) ? 1.0f : 0.0f);
      }
      for (const Sensor& sensor : scenario.sensors) {
        geometry_.push_back(ScaledDistance(scenario, {column, row}, sensor));
      }
    }
  }
}

int64_t NetworkInput::BytesFor(const World& world, NetworkInputOptions options) {
  const int64_t cells = int64_t{world.scenario().columns} * world.scenario().rows;
  const int64_t entries = options.sensor_geometry ? cells * 2 * world.sensors() : 0;
  return entries * static_cast<int64_t>(sizeof(decltype(geometry_)::value_type));
}

int NetworkInput::Size(int sensors, NetworkInputOptions options) {
  return sensors + 4 + (options.sensor_geometry ? 2 * sensors : 0);
}

void NetworkInput::Write(const State& state, std::span<float> input) const {
  FRESCO_CHECK(input.size() == static_cast<size_t>(size()));
  FRESCO_CHECK(state.aoi.size() == static_cast<size_t>(world_->sensors()));
  const Scenario& scenario = world_->scenario();
  const auto slots = static_cast<float>(scenario.slots);
  size_t next = 0;
  input[next++] = Share(state.cell.column, scenario.columns);
  input[next++] = Share(state.cell.row, scenario.rows);
  for (const int16_t aoi : state.aoi) {
    input[next++] = static_cast<float>(aoi) / slots;
  }
  input[next++] = static_cast<float>(state.time_margin) / slots;
  input[next++] = state.energy_margin_j / static_cast<float>(scenario.initial_energy_j);
  if (options_.sensor_geometry) {
    const auto entries = static_cast<int64_t>(2 * state.aoi.size());
    std::copy_n(geometry_.begin() + world_->CellIndex(state.cell) * entries, entries,
                input.begin() + static_cast<int64_t>(next));
  }
}

}  // namespace fresco
