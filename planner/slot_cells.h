// For each slot 1..T the cells over which the UAV can be then, so that tables over (slot, cell) have no
// entry for any other. Immutable after construction. A part of the exact planner.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "planner/planner_problem.h"
#include "planner/work_meter.h"

namespace fresco {

class SlotCells {
 public:
  /// Incomplete, and not to be used, where the meter has stopped.
  SlotCells(const PlannerProblem& problem, WorkMeter& meter);

  /// The cells of a slot; the cell's number is its position here.
  const std::vector<int32_t>& At(int slot) const { return cells_[static_cast<size_t>(slot)]; }
  /// The cell's number in a slot, -1 where it has none.
  int Number(int slot, int cell) const {
    return numbers_[static_cast<size_t>(slot) * cell_count_ + static_cast<size_t>(cell)];
  }
  /// Numbers through all slots: FirstPlace(slot) + number.
  size_t FirstPlace(int slot) const { return first_places_[static_cast<size_t>(slot)]; }
  size_t places() const { return first_places_.back(); }

  /// What an instance takes at most.
  static int64_t Bytes(const PlannerProblem& problem);

 private:
  size_t cell_count_;
  std::vector<std::vector<int32_t>> cells_;
  std::unique_ptr<int32_t[]> numbers_;
  std::vector<size_t> first_places_;  // by slot, and one beyond
};

}  // namespace fresco
