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

// Of an observation for sets, each with a way.
constexpr int kOwnInputs = 7 + kWayInputs;
constexpr int kSensorInputs = 7 + kWayInputs;

/// The sum of the sensors' weights. It is a sum of whole numbers, so their order changes no bit.
double TotalWeight(std::span<const Sensor> sensors) {
  int64_t total = 0;
  for (const Sensor& sensor : sensors) {
    total += static_cast<int64_t>(sensor.weight * kPartsOfWeight);
  }
  return static_cast<double>(total) / kPartsOfWeight;
}

/// The grid's longer side.
double Side(const Scenario& scenario) {
  return std::max(scenario.columns, scenario.rows) * scenario.cell_m;
}

/// The horizontal distance, divided by the grid's longer side.
float ScaledDistance(const Scenario& scenario, Cell cell, const Sensor& sensor) {
  return static_cast<float>(HorizontalDistance(cell, scenario.cell_m, sensor) / Side(scenario));
}

/// The length of the way to the sensor, as WriteWays has it.
float WayTo(const MapInput& map_input, Cell cell, const Scenario& scenario, const Sensor& sensor) {
  std::array<float, kWayInputs> way{};
  if (scenario.map->MayFly(cell)) {
    WriteWays(map_input.WaysToSensor(cell, sensor, scenario.coverage_radius_m),
              std::max(scenario.columns, scenario.rows), way);
  }
  return way[0];
}

}  // namespace

ObservationSets SetsOf(int sensors) {
  return {kOwnInputs, sensors, kSensorInputs, kMoves};
}

void WriteSets(const ObservedField& field, std::span<const float> state, std::span<float> input) {
  const double longer_side = std::max(field.columns, field.rows);
  const auto slots = static_cast<float>(field.slots);
  const double total_weight = TotalWeight(field.sensors);
  const Cell cell = CellIn(state);
  const auto cells = [&](double count) { return static_cast<float>(count / longer_side); };
  const auto metres = [&](double length_m) {
    return static_cast<float>(length_m / (longer_side * field.cell_m));
  };
  auto next = input.begin();
  *next++ = cells(cell.column);
  *next++ = cells(cell.row);
  *next++ = cells(field.stop.column - cell.column);
  *next++ = cells(field.stop.row - cell.row);
  *next++ = state[kTimeMarginField] / slots;
  *next++ = state[kEnergyMarginField] / static_cast<float>(field.initial_energy_j);
  *next++ = metres(field.coverage_radius_m);
  const auto write_ways = [&](const Ways& ways) {
    WriteWays(ways, std::max(field.columns, field.rows), std::span<float>(next, kWayInputs));
    next += kWayInputs;
  };
  write_ways(field.map_input != nullptr ? field.map_input->WaysToStop(cell, field.stop)
                                        : OpenWaysToStop(field.columns, field.rows, cell, field.stop));
  for (size_t i = 0; i < field.sensors.size(); ++i) {
    const Sensor& sensor = field.sensors[i];
    const double distance_m = HorizontalDistance(cell, field.cell_m, sensor);
    *next++ = 1;
    *next++ = metres(sensor.x_m - cell.column * field.cell_m);
    *next++ = metres(sensor.y_m - cell.row * field.cell_m);
    *next++ = metres(distance_m);
    const bool is_covered = IsWithin(field.coverage_radius_m, distance_m) &&
                            (field.map == nullptr || field.map->HasLineOfSight(cell, sensor, field.cell_m));
    *next++ = is_covered ? 1 : 0;
    *next++ = state[kAoiField + i] / slots;
    *next++ = static_cast<float>(sensor.weight / total_weight);
    write_ways(field.map_input != nullptr
                   ? field.map_input->WaysToSensor(cell, sensor, field.coverage_radius_m)
                   : OpenWaysToSensor(field.columns, field.rows, field.cell_m, cell, sensor,
                                      field.coverage_radius_m));
  }
  std::fill(next, input.end(), 0.0f);
}

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

int NetworkInput::Size(int sensors, NetworkInputOptions options) {
  if (options.sets) {
    const ObservationSets sets = SetsOf(sensors);
    return sets.own_inputs + sensors * sets.item_inputs;
  }
  return sensors + 4 + (options.sensor_geometry ? 2 * sensors : 0);
}

void NetworkInput::Write(std::span<const float> state, std::span<float> input) const {
  const auto sensors = static_cast<size_t>(world_->sensors());
  FRESCO_CHECK(input.size() == static_cast<size_t>(Size(world_->sensors(), options_)));
  FRESCO_CHECK(state.size() == kAoiField + sensors);
  const Scenario& scenario = world_->scenario();
  if (options_.sets) {
    WriteSets({scenario.columns, scenario.rows, scenario.cell_m, scenario.initial_energy_j, scenario.slots,
               scenario.coverage_radius_m, scenario.stop, scenario.sensors, world_->map(),
               map_input_ ? &*map_input_ : nullptr},
              state, input);
    return;
  }
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
