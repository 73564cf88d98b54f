#include "uav/cost_to_go.h"

#include <array>
#include <limits>

namespace fresco {
namespace {

constexpr std::array kAllMoves = {Move::kNorth, Move::kSouth, Move::kEast, Move::kWest, Move::kHover};

int64_t Width(int slot, const CostToGoOptions& options) {
  const int64_t width = std::min(slot, options.aoi_limit);
  return options.second < 0 ? width : width * width;
}

bool FitsNarrow(const PlannerProblem& problem, const CostToGoOptions& options) {
  int64_t weight = problem.weights()[static_cast<size_t>(options.first)];
  weight += options.second < 0 ? 0 : problem.weights()[static_cast<size_t>(options.second)];
  const int64_t slots = problem.slots();
  const int64_t largest = weight * slots * (slots + 1) / 2 + options.dear_price * slots;
  return largest <= std::numeric_limits<uint16_t>::max();
}

}  // namespace

SlotCells::SlotCells(const PlannerProblem& problem)
    : cell_count_(static_cast<size_t>(problem.cells())),
      cells_(static_cast<size_t>(problem.slots()) + 1),
      numbers_(cells_.size() * cell_count_, -1) {
  for (int slot = 1; slot <= problem.slots(); ++slot) {
    std::vector<int32_t>& cells = cells_[static_cast<size_t>(slot)];
    for (int cell = 0; cell < problem.cells(); ++cell) {
      if (problem.DearAllowance(slot, cell) >= 0) {
        numbers_[static_cast<size_t>(slot) * cell_count_ + static_cast<size_t>(cell)] =
            static_cast<int32_t>(cells.size());
        cells.push_back(cell);
      }
    }
  }
}

int64_t SlotCells::Bytes(const PlannerProblem& problem) {
  return int64_t{problem.slots() + 1} * problem.cells() * 2 * static_cast<int64_t>(sizeof(int32_t));
}

int64_t CostToGo::Bytes(const PlannerProblem& problem, const SlotCells& slot_cells, CostToGoOptions options) {
  const int64_t value_bytes = FitsNarrow(problem, options) ? sizeof(uint16_t) : sizeof(uint32_t);
  int64_t bytes = 0;
  for (int slot = 1; slot <= problem.slots(); ++slot) {
    bytes += static_cast<int64_t>(slot_cells.At(slot).size()) * Width(slot, options) * value_bytes;
  }
  return bytes;
}

CostToGo::CostToGo(const PlannerProblem& problem, const SlotCells& slot_cells, CostToGoOptions options)
    : problem_(&problem), slot_cells_(&slot_cells), options_(options) {
  size_t size = 0;
  offsets_.assign(static_cast<size_t>(problem.slots()) + 1, 0);
  for (int slot = 1; slot <= problem.slots(); ++slot) {
    offsets_[static_cast<size_t>(slot)] = size;
    size += slot_cells.At(slot).size() * static_cast<size_t>(Width(slot, options));
  }
  if (FitsNarrow(problem, options)) {
    narrow_.resize(size);
    Compute(narrow_);
  } else {
    wide_.resize(size);
    Compute(wide_);
  }
}

template <class Value>
void CostToGo::Compute(std::vector<Value>& values) {
  std::vector<Value> best(static_cast<size_t>(Width(problem_->slots(), options_)), 0);
  for (int slot = problem_->slots(); slot >= 1; --slot) {
    for (const int32_t cell : slot_cells_->At(slot)) {
      if (slot < problem_->slots()) {
        TakeBestMove(slot, cell, values, best);
      }
      ComputePlace(slot, cell, best, values.data() + PlaceOf(slot, slot_cells_->Number(slot, cell)).base);
    }
  }
}

/// best: for each pair of AoI at the beginning of the next slot, the cheapest cell to be over then.
template <class Value>
void CostToGo::TakeBestMove(int slot, int cell, const std::vector<Value>& values,
                            std::vector<Value>& best) const {
  const auto size = static_cast<size_t>(Width(slot + 1, options_));
  std::fill_n(best.begin(), size, std::numeric_limits<Value>::max());
  for (const Move move : kAllMoves) {
    const int after = problem_->After(cell, move);
    const int number = after < 0 ? -1 : slot_cells_->Number(slot + 1, after);
    if (number < 0) {
      continue;
    }
    const Value* next = values.data() + PlaceOf(slot + 1, number).base;
    const auto price = static_cast<Value>(problem_->IsDear(move) ? options_.dear_price : 0);
    for (size_t i = 0; i < size; ++i) {
      best[i] = std::min(best[i], static_cast<Value>(next[i] + price));
    }
  }
}

/// The slot's own cost, plus the best of the next slot after the best transmission. (Serving a covered
/// sensor is never worse than serving none.)
template <class Value>
void CostToGo::ComputePlace(int slot, int cell, const std::vector<Value>& best, Value* place) const {
  const bool last_slot = slot == problem_->slots();
  const auto weight_of = [&](int sensor) {
    return static_cast<Value>(sensor < 0 ? 0 : problem_->weights()[static_cast<size_t>(sensor)]);
  };
  const auto covers = [&](int sensor) { return !last_slot && sensor >= 0 && problem_->Covers(cell, sensor); };
  const bool covers_first = covers(options_.first);
  const bool covers_second = covers(options_.second);
  const Value first_weight = weight_of(options_.first);
  const Value second_weight = weight_of(options_.second);
  const int next_first_width = last_slot ? FirstWidth(slot) : FirstWidth(slot + 1);
  const int next_second_width = last_slot ? SecondWidth(slot) : SecondWidth(slot + 1);
  for (int first = 0; first < FirstWidth(slot); ++first) {
    const int next_first = std::min(first + 1, next_first_width - 1);
    const Value* unserved = best.data() + next_first * next_second_width;
    const Value* first_served = covers_first ? best.data() : unserved;
    const Value second_served = covers_second ? unserved[0] : std::numeric_limits<Value>::max();
    const auto own_first = static_cast<Value>(first_weight * (first + 1));
    Value* row = place + first * SecondWidth(slot);
    const auto compute = [&](int second, int next_second) {
      const Value later =
          std::min(std::min(unserved[next_second], first_served[next_second]), second_served);
      row[second] = static_cast<Value>(own_first + second_weight * (second + 1) + later);
    };
    const int inner = std::min(SecondWidth(slot), next_second_width - 1);
    for (int second = 0; second < inner; ++second) {
      compute(second, second + 1);
    }
    for (int second = inner; second < SecondWidth(slot); ++second) {
      compute(second, next_second_width - 1);
    }
  }
}

}  // namespace fresco
