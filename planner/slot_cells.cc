#include "planner/slot_cells.h"

namespace fresco {

SlotCells::SlotCells(const PlannerProblem& problem, WorkMeter& meter)
    : cell_count_(static_cast<size_t>(problem.cells())),
      cells_(static_cast<size_t>(problem.slots()) + 1),
      numbers_(std::make_unique_for_overwrite<int32_t[]>(cells_.size() * cell_count_)),
      first_places_(cells_.size() + 1, 0) {
  constexpr int64_t kUnitsPerCell = 16;
  for (int slot = 1; slot <= problem.slots() && meter.Count(problem.cells() * kUnitsPerCell); ++slot) {
    std::vector<int32_t>& cells = cells_[static_cast<size_t>(slot)];
    int32_t* numbers = numbers_.get() + static_cast<size_t>(slot) * cell_count_;
    for (int cell = 0; cell < problem.cells(); ++cell) {
      numbers[cell] = -1;
      if (problem.DearAllowance(slot, cell) >= 0) {
        numbers[cell] = static_cast<int32_t>(cells.size());
        cells.push_back(cell);
      }
    }
    first_places_[static_cast<size_t>(slot) + 1] = first_places_[static_cast<size_t>(slot)] + cells.size();
  }
}

int64_t SlotCells::Bytes(const PlannerProblem& problem) {
  // The capacity of the vectors may be twice their size.
  return int64_t{problem.slots() + 1} * problem.cells() * 3 * static_cast<int64_t>(sizeof(int32_t));
}

}  // namespace fresco
