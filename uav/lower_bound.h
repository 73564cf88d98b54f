// Lower bounds on the cost from any situation on, from tables of one or two sensors each. Any split of
// the sensors into such groups gives a bound, the sum of the groups' own optima; the largest of several
// splits is taken. As many tables as the memory allows. Immutable after construction.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "uav/cost_to_go.h"

namespace fresco {

class LowerBound {
 public:
  /// Takes about `memory_bytes` at most. `problem` must outlive the bound.
  LowerBound(const PlannerProblem& problem, int64_t memory_bytes);

  int64_t bytes() const { return bytes_; }

  /// The bound for situations over one cell at the beginning of one slot.
  class OverCell {
   public:
    OverCell(const LowerBound& bound, int slot, int cell);
    /// Of the cost of slots t..T; `aoi` as PlannerProblem::sensors(), `dear` slots flown so far.
    int64_t operator()(const int16_t* aoi, int dear);
    /// Of what the other sensors cost in the situation of the last call; as if nothing were flown for
    /// this sensor.
    int64_t WithoutSensor(int sensor) const;

   private:
    const LowerBound* bound_;
    int slots_left_;
    std::vector<CostToGo::Place> places_;  // by table
    std::vector<int64_t> values_;          // by group, for the situation of the last call
    std::vector<int64_t> sums_;            // by split
    int64_t rebate_ = 0;
  };

 private:
  /// One or two sensors; the first size() groups are the single sensors in their order.
  struct Group {
    int first;
    int second;  // -1: none
  };
  /// Groups that are disjoint and together all sensors.
  struct Split {
    std::vector<int> groups;
    std::vector<int> group_of;  // by sensor
  };

  void AddSingles(int64_t memory_bytes);
  void AddPairs(int64_t memory_bytes);
  void AddTable(const CostToGoOptions& options);
  void AddSplit(std::vector<int> groups);
  int32_t PriceShare(int sensors) const;
  int64_t RootBound(CostToGoOptions options, int32_t price_share) const;
  int64_t BestDearPrice(const CostToGoOptions& options) const;

  const PlannerProblem* problem_;
  std::unique_ptr<SlotCells> slot_cells_;  // null: not even this fits
  std::vector<Group> groups_;
  std::vector<CostToGo> tables_;  // by group; none at all where they don't fit
  std::vector<Split> splits_;
  int64_t dear_price_ = 0;  // of all groups of a split together
  int64_t bytes_ = 0;
};

}  // namespace fresco
