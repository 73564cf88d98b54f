// Lower bounds of the cost from any situation until the end. A bound is the sum of each sensor's own optimum
// at prices that make the sensors agree (price_ascent.h, cost_to_go.h). The tables of these optima are as
// fine as the memory allows; if it allows none, the bounds are weak ones without tables. Immutable after
// construction. Part of the exact planner.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "planner/cost_to_go.h"

namespace fresco {

class LowerBound {
 public:
  /// Takes at most `memory_bytes`, also during construction. `problem` must outlive the object. If the meter
  /// stops, the bounds have no tables.
  LowerBound(const PlannerProblem& problem, int64_t memory_bytes, WorkMeter& meter);

  /// The memory of the tables, bytes.
  int64_t bytes() const { return bytes_; }
  bool has_tables() const { return !tables_.empty(); }

  /// The bound at the start: no flight costs less.
  int64_t OfAnyFlight() const;

  /// The bound for situations over one cell at the beginning of one slot. Only one thread may use an object.
  class OverCell {
   public:
    /// `bound` must outlive the object.
    OverCell(const LowerBound& bound, int slot, int cell);
    /// Returns a lower bound of the cost of the slots `slot` .. T. `aoi` has one entry for each of
    /// PlannerProblem::sensors(); `dear` is the number of dear slots so far.
    int64_t operator()(const int16_t* aoi, int dear);
    /// Returns the largest number of slots from this one to the one in which the sensor is served (or to the
    /// last one), both included, in any flight whose cost of the slots `slot` .. T is below `limit`. It is
    /// for the situation of the last call of operator(), which must have returned less than `limit`.
    int LongestUnserved(int sensor, int aoi, int64_t limit) const;

   private:
    const LowerBound* bound_;
    int slots_left_;                       // with this one
    std::vector<CostToGo::Place> places_;  // by sensor; empty if there are no tables
    std::vector<int64_t> values_;          // by sensor, for the situation of the last call
    int64_t sum_ = 0;                      // of values_, minus the price of the dear slots that are still
                                           // allowed
  };

 private:
  bool ChooseSizes(int64_t memory_bytes);
  int64_t BytesToBuild() const;
  int64_t TableBytes() const;
  CostToGoOptions TableOptions(int sensor) const;
  void AddTables(WorkMeter& meter);

  const PlannerProblem* problem_;
  TableUnits units_;
  int aoi_limit_;
  int lowest_aoi_ = 1;
  std::unique_ptr<SlotCells> slot_cells_;  // null if there are no tables
  std::vector<CostToGo> tables_;           // by sensor; empty if there are no tables
  int64_t dear_price_ = 0;                 // price of a dear slot, in the tables' units
  int64_t bytes_ = 0;
};

}  // namespace fresco
