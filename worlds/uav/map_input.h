// What a network for sets sees of a map, besides what it sees of an open grid: lengths of ways round the
// obstacles and which moves shorten them. So it does not have to learn the map by heart. Immutable after
// construction, so any number of threads may share one.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "worlds/uav/obstacle_map.h"

namespace fresco {

/// A way has two kinds of input: its length in moves, divided by S, the larger number of columns and rows (at
/// most 2, also if there is none); and for each of north, south, east and west by how many moves it is
/// shorter after this move: 1, 0 or -1 (0 also if the move is not possible).
class MapInput {
 public:
  static constexpr size_t kInputs = 5;

  /// `map` must outlive the object. No radius is larger than `largest_radius_m`. Throws UsageError if so
  /// many pairs of cells hear each other at this radius that they take too much memory.
  MapInput(const ObstacleMap& map, double cell_m, double largest_radius_m);

  /// The memory of the tables, bytes; the map's are not counted.
  int64_t bytes() const {
    return static_cast<int64_t>(first_.size() * sizeof(first_[0]) +
                                seen_from_.size() * sizeof(seen_from_[0]) +
                                squares_.size() * sizeof(squares_[0]));
  }

  /// Writes the kInputs of the way from `cell` to the stop.
  void WriteWayToStop(Cell cell, Cell stop, std::span<float> input) const;
  /// Writes the kInputs of the way from `cell` to the nearest cell that covers a sensor with this radius. The
  /// sensor counts as one in the centre of the cell in which it stands (random sensors do stand there).
  void WriteWayToSensor(Cell cell, const Sensor& sensor, double radius_m, std::span<float> input) const;

 private:
  using Rows = std::array<const int16_t*, kInputs>;  // distances to: the cell, and those after the four moves

  Rows RowsAround(Cell cell) const;
  void Write(std::array<int16_t, kInputs> distances, std::span<float> input) const;
  int IndexOf(Cell cell) const { return cell.row * map_->columns() + cell.column; }

  const ObstacleMap* map_;
  double cell_m_;
  // For each cell, those over which the UAV hears a sensor in its centre: seen_from_[first_[cell]] to before
  // first_[cell + 1], the nearest ones first; squares_ has the squares of their distances in cells.
  std::vector<uint32_t> first_;
  std::vector<int16_t> seen_from_;
  std::vector<int32_t> squares_;
};

}  // namespace fresco
