// Lists, for each slot 1 .. T, the cells over which the UAV can be in a flight that arrives. Tables by slot
// and cell have entries for these only. Immutable after construction, so any thread may read it. Part of
// the exact planner.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "planner/planner_problem.h"
#include "planner/work_meter.h"

namespace fresco {

class SlotCells {
 public:
  /// If the meter has stopped, the object is incomplete and must not be used.
  SlotCells(const PlannerProblem& problem, WorkMeter& meter);

  /// The cells of a slot. A cell's number is its position in this list.
  const std::vector<int32_t>& At(int slot) const { return cells_[static_cast<size_t>(slot)]; }
  /// A cell's number in a slot; -1 if the UAV can't be there.
  int Number(int slot, int cell) const {
    return numbers_[static_cast<size_t>(slot) * cell_count_ + static_cast<size_t>(cell)];
  }
  /// A place is a pair of slot and cell. Its index among all places is FirstPlace(slot) + number.
  size_t FirstPlace(int slot) const { return first_places_[static_cast<size_t>(slot)]; }
  size_t places() const { return first_places_.back(); }

  /// The most memory that an object takes, bytes.
  static int64_t Bytes(const PlannerProblem& problem);

 private:
  size_t cell_count_;
  std::vector<std::vector<int32_t>> cells_;
  std::unique_ptr<int32_t[]> numbers_;
  std::vector<size_t> first_places_;  // by slot; the last entry is the number of all places
};

}  // namespace fresco
