#include "planner/cost_to_go.h"

#include <limits>

namespace fresco {

CostToGo::CostToGo(const PlannerProblem& problem, const SlotCells& slot_cells, const WholePrices& prices,
                   const CostToGoOptions& options, WorkMeter& meter)
    : slot_cells_(&slot_cells), options_(options), offsets_(static_cast<size_t>(problem.slots()) + 1, 0) {
  size_t size = 0;
  for (int slot = 1; slot <= problem.slots(); ++slot) {
    offsets_[static_cast<size_t>(slot)] = size;
    size += slot_cells.At(slot).size() * static_cast<size_t>(Width(slot));
  }
  costs_ = std::make_unique_for_overwrite<int32_t[]>(size);
  best_next_.assign(static_cast<size_t>(Width(problem.slots())), 0);
  for (int slot = problem.slots(); slot >= 1; --slot) {
    for (int number = 0; number < static_cast<int>(slot_cells.At(slot).size()); ++number) {
      constexpr int64_t kUnitsPerEntry = 8;
      if (!meter.Count(Width(slot) * kUnitsPerEntry)) {
        return;
      }
      if (slot < problem.slots()) {
        ComputeBestNext(problem, slot, slot_cells.At(slot)[static_cast<size_t>(number)], prices.dear_share);
      }
      ComputePlace(problem, prices, slot, number);
    }
  }
}

int64_t CostToGo::Bytes(const PlannerProblem& problem, const SlotCells& slot_cells,
                        const CostToGoOptions& options) {
  int64_t entries = 0;
  for (int slot = 1; slot <= problem.slots(); ++slot) {
    entries += static_cast<int64_t>(slot_cells.At(slot).size()) *
               (std::min(slot, options.aoi_limit) - options.lowest_aoi + 1);
  }
  return entries * static_cast<int64_t>(sizeof(int32_t));
}

size_t CostToGo::Offset(int slot, int number) const {
  return offsets_[static_cast<size_t>(slot)] + static_cast<size_t>(number) * static_cast<size_t>(Width(slot));
}

CostToGo::Place CostToGo::PlaceOf(int slot, int number) const {
  return {costs_.get() + Offset(slot, number), options_.lowest_aoi, HighestAoi(slot)};
}

// Writes to best_next_, for each AoI in the next slot, the least cost over the cells that the UAV can move
// to.
void CostToGo::ComputeBestNext(const PlannerProblem& problem, int slot, int cell, int32_t dear_share) {
  const int width = Width(slot + 1);
  std::fill_n(best_next_.begin(), width, std::numeric_limits<int32_t>::max());
  for (const Move move : kAllMoves) {
    const int after = problem.After(cell, move);
    const int number = after < 0 ? -1 : slot_cells_->Number(slot + 1, after);
    if (number < 0) {
      continue;
    }
    const int32_t* next = costs_.get() + Offset(slot + 1, number);
    const int32_t price = problem.IsDear(move) ? dear_share : 0;
    for (int i = 0; i < width; ++i) {
      best_next_[static_cast<size_t>(i)] = std::min(best_next_[static_cast<size_t>(i)], next[i] + price);
    }
  }
}

// The cost over a cell is the slot's own cost and price, plus the least cost of the next slot; it is
// the lesser of the costs with and without serving the sensor now.
void CostToGo::ComputePlace(const PlannerProblem& problem, const WholePrices& prices, int slot, int number) {
  const bool last_slot = slot == problem.slots();
  const int cell = slot_cells_->At(slot)[static_cast<size_t>(number)];
  const size_t place = slot_cells_->FirstPlace(slot) + static_cast<size_t>(number);
  const auto sensor = static_cast<size_t>(options_.sensor);
  const int32_t presence = prices.presence[place * static_cast<size_t>(problem.size()) + sensor];
  const int32_t served =
      !last_slot && problem.Covers(cell, options_.sensor)
          ? best_next_[static_cast<size_t>(1 - options_.lowest_aoi)] + prices.transmission[place]
          : std::numeric_limits<int32_t>::max();
  const int width = Width(slot);
  const int last_next = (last_slot ? width : Width(slot + 1)) - 1;
  const int32_t* later = best_next_.data();
  int32_t* cost = costs_.get() + Offset(slot, number);
  const int growing = std::min(width, last_next);
  for (int i = 0; i < growing; ++i) {
    cost[i] = options_.weight * (i + options_.lowest_aoi) + presence + std::min(later[i + 1], served);
  }
  for (int i = growing; i < width; ++i) {
    cost[i] = options_.weight * (i + options_.lowest_aoi) + presence + std::min(later[last_next], served);
  }
}

}  // namespace fresco
