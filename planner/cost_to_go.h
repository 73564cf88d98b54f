// A table of the least cost of one sensor from any situation (slot, cell, AoI) until the end, if the UAV flew
// for this sensor alone at the prices of price_ascent.h. It is computed exactly, in whole numbers, by
// backward dynamic programming. Immutable after construction, so any thread may read it.
// Part of the exact planner; LowerBound owns it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "planner/slot_cells.h"

namespace fresco {

/// Converts between costs and the values of a table, which are costs times 2^shift. The rounding keeps sums
/// of table values lower bounds.
struct TableUnits {
  int shift = 0;

  /// Returns weight x 2^shift, rounded down.
  int64_t Weight(int64_t weight) const { return shift >= 0 ? weight << shift : weight >> -shift; }
  /// Returns the cost that a sum of table values proves: no flight costs less.
  int64_t CostOf(int64_t value) const {
    return shift >= 0 ? -((-value) >> shift) : value * (int64_t{1} << -shift);
  }
  /// Returns the least table value for which CostOf is `cost` or more.
  int64_t ValueOf(int64_t cost) const {
    return shift >= 0 ? (cost - 1) * (int64_t{1} << shift) + 1 : -((-cost) >> -shift);
  }
};

/// CellPrices (price_ascent.h) as whole numbers in a table's units. In every place, the presence prices of
/// all sensors and the transmission price sum to zero.
struct WholePrices {
  std::vector<int32_t> presence;      ///< [places x sensors]
  std::vector<int32_t> transmission;  ///< [places]
  int32_t dear_share = 0;             ///< what each sensor pays for a dear slot
};

struct CostToGoOptions {
  int sensor = 0;      ///< index into PlannerProblem::sensors()
  int32_t weight = 0;  ///< in the table's units
  int aoi_limit = 0;   ///< a larger AoI counts as this one; a small limit gives small tables and weak bounds
  int lowest_aoi = 1;  ///< 1, or less: OverCell::LongestUnserved uses AoI below 1, which no flight has
};

class CostToGo {
 public:
  /// Computes the table. `slot_cells` must outlive it. If the meter has stopped, the table is incomplete and
  /// must not be used.
  CostToGo(const PlannerProblem& problem, const SlotCells& slot_cells, const WholePrices& prices,
           const CostToGoOptions& options, WorkMeter& meter);

  /// The costs in one slot over one cell.
  struct Place {
    const int32_t* costs = nullptr;  ///< for each AoI from lowest_aoi to highest_aoi
    int lowest_aoi = 1;
    int highest_aoi = 1;

    /// The cost for an AoI, which is at least lowest_aoi.
    int32_t At(int aoi) const { return costs[std::min(aoi, highest_aoi) - lowest_aoi]; }
  };
  /// The costs of the slots `slot` .. T, prices included, over the cell with this number (SlotCells), by the
  /// AoI at the beginning of `slot`.
  Place PlaceOf(int slot, int number) const;

  /// The memory of a table, bytes.
  static int64_t Bytes(const PlannerProblem& problem, const SlotCells& slot_cells,
                       const CostToGoOptions& options);

 private:
  int HighestAoi(int slot) const { return std::min(slot, options_.aoi_limit); }
  int Width(int slot) const { return HighestAoi(slot) - options_.lowest_aoi + 1; }
  size_t Offset(int slot, int number) const;
  void ComputeBestNext(const PlannerProblem& problem, int slot, int cell, int32_t dear_share);
  void ComputePlace(const PlannerProblem& problem, const WholePrices& prices, int slot, int number);

  const SlotCells* slot_cells_;
  CostToGoOptions options_;
  std::vector<size_t> offsets_;  // by slot
  std::unique_ptr<int32_t[]> costs_;
  std::vector<int32_t> best_next_;  // used while the table is computed; by AoI in the next slot
};

}  // namespace fresco
