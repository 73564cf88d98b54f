// The least cost that one or two sensors can have from any situation on, were the UAV flying for them
// alone: exact, by backward dynamic programming over (slot, cell, AoI). Sums of such tables over
// disjoint groups of sensors are lower bounds for all of them together. Immutable after construction.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "uav/planner_problem.h"

namespace fresco {

/// For each slot 1..T the cells over which the UAV can be then, numbered.
class SlotCells {
 public:
  explicit SlotCells(const PlannerProblem& problem);

  const std::vector<int32_t>& At(int slot) const { return cells_[static_cast<size_t>(slot)]; }
  /// The cell's number in a slot, -1 where it has none.
  int Number(int slot, int cell) const {
    return numbers_[static_cast<size_t>(slot) * cell_count_ + static_cast<size_t>(cell)];
  }
  static int64_t Bytes(const PlannerProblem& problem);

 private:
  size_t cell_count_;
  std::vector<std::vector<int32_t>> cells_;
  std::vector<int32_t> numbers_;
};

/// What a table is made for.
struct CostToGoOptions {
  int first = 0;           ///< index into PlannerProblem::sensors()
  int second = -1;         ///< another one; -1: none
  int aoi_limit = 0;       ///< AoI beyond it count as it: smaller tables, weaker bounds
  int32_t dear_price = 0;  ///< cost of each dear slot (PlannerProblem::IsDear)
};

class CostToGo {
 public:
  CostToGo(const PlannerProblem& problem, const SlotCells& slot_cells, CostToGoOptions options);

  /// A slot and cell of the table.
  struct Place {
    size_t base = 0;
    int first_width = 1;
    int second_width = 1;
  };
  /// `number`: the cell's, from SlotCells.
  Place PlaceOf(int slot, int number) const {
    const int first_width = FirstWidth(slot);
    const int second_width = SecondWidth(slot);
    return {offsets_[static_cast<size_t>(slot)] +
                static_cast<size_t>(number) * static_cast<size_t>(first_width * second_width),
            first_width, second_width};
  }

  /// The least cost of slots t..T for the AoI at the beginning of slot t, dear slots from t on priced.
  uint32_t At(const Place& place, const int16_t* aoi) const {
    const int first = std::min<int>(aoi[options_.first], place.first_width) - 1;
    const int second = options_.second < 0 ? 0 : std::min<int>(aoi[options_.second], place.second_width) - 1;
    const size_t index = place.base + static_cast<size_t>(first * place.second_width + second);
    return narrow_.empty() ? wide_[index] : narrow_[index];
  }

  static int64_t Bytes(const PlannerProblem& problem, const SlotCells& slot_cells, CostToGoOptions options);

 private:
  int FirstWidth(int slot) const { return std::min(slot, options_.aoi_limit); }
  int SecondWidth(int slot) const { return options_.second < 0 ? 1 : FirstWidth(slot); }
  template <class Value>
  void Compute(std::vector<Value>& values);
  template <class Value>
  void TakeBestMove(int slot, int cell, const std::vector<Value>& values, std::vector<Value>& best) const;
  template <class Value>
  void ComputePlace(int slot, int cell, const std::vector<Value>& best, Value* place) const;

  const PlannerProblem* problem_;
  const SlotCells* slot_cells_;
  CostToGoOptions options_;
  std::vector<size_t> offsets_;   // by slot
  std::vector<uint16_t> narrow_;  // one of the two, as narrow as the largest cost allows
  std::vector<uint32_t> wide_;
};

}  // namespace fresco
