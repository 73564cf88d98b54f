#include "worlds/uav/map_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "worlds/uav/uav_world.h"

namespace fresco {
namespace {

constexpr size_t kMaximumPairs = 8'000'000;  // 48 MB

/// The square of a radius, in cells, with the tolerance of IsWithin.
double SquareInCells(double radius_m, double cell_m) {
  const double cells = radius_m / cell_m * kRadiusLeeway;
  return cells * cells;
}

}  // namespace

MapInput::MapInput(const ObstacleMap& map, double cell_m, double largest_radius_m)
    : map_(&map), cell_m_(cell_m), first_({0}) {
  const double largest_square = SquareInCells(largest_radius_m, cell_m);
  std::vector<std::pair<int32_t, int16_t>> heard;  // square, cell
  for (int index = 0; index < map.columns() * map.rows(); ++index) {
    const Cell place = {index % map.columns(), index / map.columns()};
    const Sensor sensor = {place.column * cell_m, place.row * cell_m, 1};
    heard.clear();
    for (int row = 0; row < map.rows(); ++row) {
      for (int column = 0; column < map.columns(); ++column) {
        const Cell cell = {column, row};
        const int square =
            (column - place.column) * (column - place.column) + (row - place.row) * (row - place.row);
        if (square <= largest_square && map.MayFly(cell) && map.HasLineOfSight(cell, sensor, cell_m)) {
          heard.emplace_back(square, static_cast<int16_t>(IndexOf(cell)));
        }
      }
    }
    if (seen_from_.size() + heard.size() > kMaximumPairs) {
      throw UsageError(
          fmt::format("scenario.map_row: with a coverage radius of {} m and this scenario.map_row, more than "
                      "{} pairs of cells "
                      "hear each other; allowed: a smaller radius or map",
                      largest_radius_m, kMaximumPairs));
    }
    std::sort(heard.begin(), heard.end());
    for (const auto& [square, cell] : heard) {
      seen_from_.push_back(cell);
      squares_.push_back(square);
    }
    first_.push_back(static_cast<uint32_t>(seen_from_.size()));
  }
}

MapInput::Rows MapInput::RowsAround(Cell cell) const {
  Rows rows;
  rows[0] = map_->DistancesTo(cell).data();
  for (size_t move = 0; move + 1 < kWayInputs; ++move) {
    const Cell next = {cell.column + kMoveSteps[move].column, cell.row + kMoveSteps[move].row};
    rows[move + 1] = map_->MayFly(next) ? map_->DistancesTo(next).data() : rows[0];
  }
  return rows;
}

Ways MapInput::WaysToStop(Cell cell, Cell stop) const {
  const auto to = static_cast<size_t>(IndexOf(stop));
  const Rows rows = RowsAround(cell);
  return {rows[0][to], rows[1][to], rows[2][to], rows[3][to], rows[4][to]};
}

Ways MapInput::WaysToSensor(Cell cell, const Sensor& sensor, double radius_m) const {
  const double largest_square = SquareInCells(radius_m, cell_m_);
  const auto place = static_cast<size_t>(IndexOf(CellOf(sensor, cell_m_, map_->columns(), map_->rows())));
  const Rows rows = RowsAround(cell);
  Ways least;
  least.fill(ObstacleMap::kCutOff);
  for (uint32_t i = first_[place]; i < first_[place + 1] && squares_[i] <= largest_square; ++i) {
    const auto to = static_cast<size_t>(seen_from_[i]);
    for (size_t row = 0; row < kWayInputs; ++row) {
      least[row] = std::min(least[row], rows[row][to]);
    }
  }
  return least;
}

}  // namespace fresco
