// Lower bounds on the cost from any situation on: the sum of every sensor's own optimum at prices that
// make the sensors agree (price_ascent.h, cost_to_go.h). As good tables as the memory allows; none at all
// where it allows none. Immutable after construction. A part of the exact planner.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "planner/cost_to_go.h"

namespace fresco {

class LowerBound {
 public:
  /// Takes `memory_bytes` at most, while it is built too. `problem` must outlive the bound. Where the
  /// meter stops, the bound is one without tables.
  LowerBound(const PlannerProblem& problem, int64_t memory_bytes, WorkMeter& meter);

  /// What it keeps.
  int64_t bytes() const { return bytes_; }
  bool has_tables() const { return !tables_.empty(); }

  /// No flight costs less.
  int64_t OfAnyFlight() const;

  /// The bound for situations over one cell at the beginning of one slot.
  class OverCell {
   public:
    OverCell(const LowerBound& bound, int slot, int cell);
    /// Of the cost of slots t..T; `aoi` as PlannerProblem::sensors(), `dear` slots flown so far.
    int64_t operator()(const int16_t* aoi, int dear);
    /// In how many slots from this one on the sensor's present AoI can go on growing, in a flight whose
    /// cost of slots t..T is below `limit`; in the situation of the last call, its bound below `limit`.
    int LongestUnserved(int sensor, int aoi, int64_t limit) const;

   private:
    const LowerBound* bound_;
    int slots_left_;                       // this one included
    std::vector<CostToGo::Place> places_;  // by sensor; none without tables
    std::vector<int64_t> values_;          // by sensor, for the situation of the last call
    int64_t sum_ = 0;                      // of them, less what unused dear slots would have paid
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
  std::unique_ptr<SlotCells> slot_cells_;  // null: not even this fits
  std::vector<CostToGo> tables_;           // by sensor; all or none
  int64_t dear_price_ = 0;                 // of a dear slot, in the tables' units
  int64_t bytes_ = 0;
};

}  // namespace fresco
