// The map of a scenario: which cells can't be flown over, which block radio, and in which ones flights may
// start and end. Everything that follows from the cells alone is tabulated here, so that all fields over a
// map share it: the lengths of the shortest ways, and which cells hang together. Immutable after
// construction, so any number of threads may share one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "worlds/uav/scenario.h"

namespace fresco {

/// What a cell of a map is, as the character that `scenario.map_row` has for it.
enum class CellKind : char {
  kFree = '.',
  kNoFlying = 'N',         ///< radio passes
  kBlocksRadio = 'R',      ///< can be flown over
  kBlocksBoth = 'B',       ///< no flying, and blocks radio
  kStartAndLanding = 'S',  ///< free; flights may start and end here
};

/// The most cells of a map. The table of the ways between them then takes 32 MiB.
inline constexpr int kMaximumMapCells = 4096;

class ObstacleMap {
 public:
  /// The distance of a cell that no flight leads to. It is more than any flight has slots.
  static constexpr int kCutOff = 1 << 14;

  /// `rows` has the cells as text, the northern row first, each from west to east. Throws UsageError as
  /// CheckRows does.
  explicit ObstacleMap(const std::vector<std::string>& rows);

  /// Throws UsageError if there are no rows, a row is empty or not as long as the first one, a character is
  /// none of a CellKind, or there are more than kMaximumMapCells. It names row, character and what is
  /// allowed.
  static void CheckRows(const std::vector<std::string>& rows);
  /// The cells of kind kStartAndLanding in checked rows, the southern row first, each from west to east.
  static std::vector<Cell> ZonesIn(const std::vector<std::string>& rows);

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  /// The map as text again.
  std::vector<std::string> Text() const;
  /// The memory of the tables, bytes.
  int64_t bytes() const;

  bool OnMap(Cell cell) const {
    return (static_cast<unsigned>(cell.column) < static_cast<unsigned>(columns_)) &
           (static_cast<unsigned>(cell.row) < static_cast<unsigned>(rows_));
  }
  /// The kind of a cell on the map.
  CellKind KindOf(Cell cell) const { return kinds_[IndexOf(cell)]; }
  /// Whether the UAV may be over the cell; false off the map.
  bool MayFly(Cell cell) const { return OnMap(cell) && may_fly_[IndexOf(cell)] != 0; }
  /// Whether the cell, which is on the map, blocks radio.
  bool BlocksRadio(Cell cell) const {
    return KindOf(cell) == CellKind::kBlocksRadio || KindOf(cell) == CellKind::kBlocksBoth;
  }
  /// The cells of kind kStartAndLanding, in the order of ZonesIn.
  const std::vector<Cell>& zones() const { return zones_; }

  /// For each cell (row by row from the south, each from the west) the moves of a shortest flight between it
  /// and `cell`, which is on the map; kCutOff if there is none. Flights go from cell to neighbouring cell,
  /// over those that MayFly.
  std::span<const int16_t> DistancesTo(Cell cell) const {
    return std::span(distances_).subspan(IndexOf(cell) * may_fly_.size(), may_fly_.size());
  }
  /// The moves of a shortest flight between two cells of the map.
  int Distance(Cell a, Cell b) const { return DistancesTo(a)[IndexOf(b)]; }
  /// The cells that flights from `cell` lead to, itself included, in the order of DistancesTo; none if the
  /// UAV may not be over it.
  const std::vector<Cell>& CellsAround(Cell cell) const {
    return components_[static_cast<size_t>(component_of_[IndexOf(cell)])];
  }

  /// Whether radio passes between the UAV over `cell` and a sensor: the straight line on the ground from the
  /// cell's centre to the sensor does not go through the inside of a cell that blocks radio, other than the
  /// one in which the sensor stands. (So it may touch an edge or a corner, and over a cell that blocks radio
  /// the UAV hears only sensors that stand there.) The sensor's place is rounded to a 2^16-th of a cell and
  /// the rest is computed in whole numbers, so the last bits of a place decide nothing; on an edge between
  /// two cells, a sensor stands in the western or southern one. `cell` and sensor are on the map.
  bool HasLineOfSight(Cell cell, const Sensor& sensor, double cell_m) const;

 private:
  size_t IndexOf(Cell cell) const {
    return static_cast<size_t>(cell.row) * static_cast<size_t>(columns_) + static_cast<size_t>(cell.column);
  }
  void TabulateDistances(Cell from, std::vector<Cell>& reached);

  int columns_;
  int rows_;
  std::vector<CellKind> kinds_;
  std::vector<uint8_t> may_fly_;
  std::vector<Cell> zones_;
  std::vector<int16_t> distances_;             // [cells x cells]
  std::vector<int16_t> component_of_;          // by cell
  std::vector<std::vector<Cell>> components_;  // the first one is empty: of cells that can't be flown over
};

/// The cell in which a sensor stands; on an edge, the western or southern one. Off the map, the nearest cell.
Cell CellOf(const Sensor& sensor, double cell_m, int columns, int rows);

}  // namespace fresco
