// The least cost that one sensor can have from any situation on, were the UAV flying for it alone at the
// prices of price_ascent.h: exact, in whole numbers, by backward dynamic programming over (slot, cell,
// AoI). Immutable after construction. A part of the exact planner.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "planner/slot_cells.h"

namespace fresco {

/// Costs and prices in the whole units of a table: cost times 2^shift, rounded so that sums of tables stay
/// lower bounds.
struct TableUnits {
  int shift = 0;

  /// At most weight x 2^shift.
  int64_t Weight(int64_t weight) const { return shift >= 0 ? weight << shift : weight >> -shift; }
  /// What a sum of table values says about a whole cost: it is no smaller.
  int64_t CostOf(int64_t value) const {
    return shift >= 0 ? -((-value) >> shift) : value * (int64_t{1} << -shift);
  }
  /// The least table value that says: the cost is not below `cost`.
  int64_t ValueOf(int64_t cost) const {
    return shift >= 0 ? (cost - 1) * (int64_t{1} << shift) + 1 : -((-cost) >> -shift);
  }
};

/// As CellPrices, but whole: in every place the presence of all sensors and the transmission sum to zero.
struct WholePrices {
  std::vector<int32_t> presence;      // [places x sensors]
  std::vector<int32_t> transmission;  // [places]
  int32_t dear_share = 0;             // of a dear slot, what every sensor pays
};

struct CostToGoOptions {
  int sensor = 0;      ///< index into PlannerProblem::sensors()
  int32_t weight = 0;  ///< in the table's units
  int aoi_limit = 0;   ///< AoI beyond it count as it: smaller tables, weaker bounds
  int lowest_aoi = 1;  ///< 1, or below: AoI that no flight has, for LowerBound::LongestUnserved
};

class CostToGo {
 public:
  /// Incomplete, and not to be used, where the meter has stopped.
  CostToGo(const PlannerProblem& problem, const SlotCells& slot_cells, const WholePrices& prices,
           const CostToGoOptions& options, WorkMeter& meter);

  /// The costs in one slot over one cell.
  struct Place {
    const int32_t* costs = nullptr;  // of lowest_aoi to highest_aoi
    int lowest_aoi = 1;
    int highest_aoi = 1;

    int32_t At(int aoi) const { return costs[std::min(aoi, highest_aoi) - lowest_aoi]; }
  };
  /// `number`: the cell's, from SlotCells. Its costs are of slots t..T for the AoI at the beginning of slot
  /// t, prices from t on included.
  Place PlaceOf(int slot, int number) const;

  static int64_t Bytes(const PlannerProblem& problem, const SlotCells& slot_cells,
                       const CostToGoOptions& options);

 private:
  int HighestAoi(int slot) const { return std::min(slot, options_.aoi_limit); }
  int Width(int slot) const { return HighestAoi(slot) - options_.lowest_aoi + 1; }
  size_t Offset(int slot, int number) const;
  void TakeBestNext(const PlannerProblem& problem, int slot, int cell, int32_t dear_share);
  void ComputePlace(const PlannerProblem& problem, const WholePrices& prices, int slot, int number);

  const SlotCells* slot_cells_;
  CostToGoOptions options_;
  std::vector<size_t> offsets_;  // by slot
  std::unique_ptr<int32_t[]> costs_;
  std::vector<int32_t> best_next_;  // while it is computed: by AoI in the next slot
};

}  // namespace fresco
