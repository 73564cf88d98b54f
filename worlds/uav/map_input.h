// The ways (ways.h) round the obstacles of a map. So a network for sets does not have to learn the map by
// heart. Immutable after construction, so any number of threads may share one.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "worlds/uav/obstacle_map.h"
#include "worlds/uav/ways.h"

namespace fresco {

class MapInput {
 public:
  /// `map` must outlive the object. No radius is larger than `largest_radius_m`. Throws UsageError if so
  /// many pairs of cells hear each other at this radius that they take too much memory.
  MapInput(const ObstacleMap& map, double cell_m, double largest_radius_m);

  /// The memory of the tables, bytes; the map's are not counted.
  int64_t bytes() const {
    return static_cast<int64_t>(first_.size() * sizeof(first_[0]) +
                                seen_from_.size() * sizeof(seen_from_[0]) +
                                squares_.size() * sizeof(squares_[0]));
  }

  /// The ways from `cell`, over which the UAV may fly, to the stop.
  Ways WaysToStop(Cell cell, Cell stop) const;
  /// The ways from `cell` to the nearest cell that covers a sensor with this radius. The sensor counts as one
  /// in the centre of the cell in which it stands (random sensors do stand there).
  Ways WaysToSensor(Cell cell, const Sensor& sensor, double radius_m) const;

 private:
  using Rows =
      std::array<const int16_t*, kWayInputs>;  // distances to: the cell, and those after the four moves

  Rows RowsAround(Cell cell) const;
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
