#include "worlds/uav/scenario.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/random.h"
#include "worlds/uav/obstacle_map.h"

namespace fresco {

double HorizontalDistance(Cell cell, double cell_m, const Sensor& sensor) {
  const double x_m = cell.column * cell_m - sensor.x_m;
  const double y_m = cell.row * cell_m - sensor.y_m;
  return std::sqrt(x_m * x_m + y_m * y_m);
}

std::vector<Sensor> RandomSensors(int columns, int rows, double cell_m, int count, uint64_t seed) {
  FRESCO_CHECK(count >= 0);
  RandomStream stream(seed, RandomPurpose::kSensorPlacement, 0, 0);
  std::vector<Sensor> sensors(static_cast<size_t>(count));
  for (Sensor& sensor : sensors) {
    sensor.x_m = (stream.NextUniform() * columns - 0.5) * cell_m;
    sensor.y_m = (stream.NextUniform() * rows - 0.5) * cell_m;
  }
  return sensors;
}

std::vector<Sensor> RandomSensors(const Scenario& scenario, int count, uint64_t seed) {
  if (scenario.map == nullptr) {
    return RandomSensors(scenario.columns, scenario.rows, scenario.cell_m, count, seed);
  }
  std::vector<Cell> cells;
  for (const Cell cell : scenario.map->CellsAround(scenario.start)) {
    if (!scenario.map->BlocksRadio(cell)) {
      cells.push_back(cell);
    }
  }
  if (static_cast<size_t>(count) > cells.size()) {
    throw UsageError(fmt::format(
        "scenario.random_sensors: {} sensors are too many for scenario.map_row, which has {} cells "
        "without an obstacle around scenario.start; allowed: one sensor for each of these cells",
        count, cells.size()));
  }
  RandomStream stream(seed, RandomPurpose::kSensorPlacement, 0, 0);
  std::vector<Sensor> sensors;
  for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
    std::swap(cells[i], cells[i + stream.NextBelow(static_cast<uint32_t>(cells.size() - i))]);
    sensors.push_back({cells[i].column * scenario.cell_m, cells[i].row * scenario.cell_m, 1});
  }
  return sensors;
}

}  // namespace fresco
