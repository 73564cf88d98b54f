#include "worlds/uav/ways.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "worlds/uav/obstacle_map.h"
#include "worlds/uav/uav_world.h"

namespace fresco {
namespace {

std::array<Cell, kWayInputs> CellsAround(int columns, int rows, Cell cell) {
  std::array<Cell, kWayInputs> cells;
  cells[0] = cell;
  for (size_t move = 0; move + 1 < kWayInputs; ++move) {
    cells[move + 1] = {std::clamp(cell.column + kMoveSteps[move].column, 0, columns - 1),
                       std::clamp(cell.row + kMoveSteps[move].row, 0, rows - 1)};
  }
  return cells;
}

/// The columns of one row that cover a sensor: first .. last, none if first > last.
struct CoveringColumns {
  int first = 0;
  int last = -1;
};

CoveringColumns CoveringColumnsOf(int row, int columns, double cell_m, const Sensor& sensor,
                                  double radius_m) {
  const auto covers = [&](int column) {
    return column >= 0 && column < columns &&
           IsWithin(radius_m, HorizontalDistance({column, row}, cell_m, sensor));
  };
  const double sensor_column = std::clamp(sensor.x_m / cell_m, 0.0, columns - 1.0);
  const int nearest = static_cast<int>(std::lround(sensor_column));
  if (!covers(nearest)) {
    return {};
  }
  // These two are right but for rounding, so they are set right with the rule itself.
  const double y_m = row * cell_m - sensor.y_m;
  const double half_width_m = std::sqrt(std::max(0.0, radius_m * radius_m - y_m * y_m));
  int first = static_cast<int>(std::clamp((sensor.x_m - half_width_m) / cell_m + 1, 0.0, 1.0 * nearest));
  int last = static_cast<int>(std::clamp((sensor.x_m + half_width_m) / cell_m, 1.0 * nearest, columns - 1.0));
  while (!covers(first)) {
    ++first;
  }
  while (covers(first - 1)) {
    --first;
  }
  while (!covers(last)) {
    --last;
  }
  while (covers(last + 1)) {
    ++last;
  }
  return {first, last};
}

}  // namespace

void WriteWays(const Ways& ways, int longer_side, std::span<float> input) {
  input[0] = static_cast<float>(std::min<int>(ways[0], 2 * longer_side)) / static_cast<float>(longer_side);
  for (size_t i = 1; i < kWayInputs; ++i) {
    input[i] = static_cast<float>(ways[0] - ways[i]);
  }
}

Ways OpenWaysToStop(int columns, int rows, Cell cell, Cell stop) {
  Ways ways;
  const std::array<Cell, kWayInputs> from = CellsAround(columns, rows, cell);
  for (size_t i = 0; i < kWayInputs; ++i) {
    ways[i] = static_cast<int16_t>(std::abs(from[i].column - stop.column) + std::abs(from[i].row - stop.row));
  }
  return ways;
}

Ways OpenWaysToSensor(int columns, int rows, double cell_m, Cell cell, const Sensor& sensor,
                      double radius_m) {
  Ways ways;
  ways.fill(ObstacleMap::kCutOff);
  const std::array<Cell, kWayInputs> from = CellsAround(columns, rows, cell);
  // One row more on both sides, since the quotients are rounded.
  const auto row_of = [&](double row) { return static_cast<int>(std::clamp(row, 0.0, rows - 1.0)); };
  const int first_row = row_of((sensor.y_m - radius_m) / cell_m - 1);
  const int last_row = row_of((sensor.y_m + radius_m) / cell_m + 1);
  for (int row = first_row; row <= last_row; ++row) {
    const CoveringColumns covering = CoveringColumnsOf(row, columns, cell_m, sensor, radius_m);
    if (covering.first > covering.last) {
      continue;
    }
    for (size_t i = 0; i < kWayInputs; ++i) {
      const int across = std::max({0, covering.first - from[i].column, from[i].column - covering.last});
      ways[i] = std::min(ways[i], static_cast<int16_t>(std::abs(row - from[i].row) + across));
    }
  }
  return ways;
}

}  // namespace fresco
