#include "uav/price_ascent.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fresco {
namespace {

constexpr float kNever = 1e30f;
constexpr int kSweepsBetweenChecks = 8;
constexpr double kLeastGain = 0.004;  // of the bound, in so many sweeps
constexpr int64_t kMostWork = int64_t{1} << 35;
constexpr int64_t kUnitsPerEntry = 12;  // of a sweep in one direction

// Least of a[i] + b[i]. In lanes, as the compiler may not reorder a minimum of floats by itself.
float LeastSum(const float* a, const float* b, int size) {
  constexpr int kLanes = 8;
  float lanes[kLanes];
  std::fill_n(lanes, kLanes, kNever);
  int begin = 0;
  for (; begin + kLanes <= size; begin += kLanes) {
    for (int i = 0; i < kLanes; ++i) {
      const float sum = a[begin + i] + b[begin + i];
      lanes[i] = sum < lanes[i] ? sum : lanes[i];
    }
  }
  float least = *std::min_element(lanes, lanes + kLanes);
  for (; begin < size; ++begin) {
    least = std::min(least, a[begin] + b[begin]);
  }
  return least;
}

}  // namespace

PriceAscent::PriceAscent(const PlannerProblem& problem, const SlotCells& slot_cells, int aoi_limit,
                         WorkMeter& meter)
    : problem_(&problem),
      slot_cells_(&slot_cells),
      aoi_limit_(aoi_limit),
      meter_(&meter),
      sensors_(static_cast<size_t>(problem.size())),
      dear_step_(static_cast<double>(*std::max_element(problem.weights().begin(), problem.weights().end()))) {
  prices_.presence.assign(slot_cells.places() * sensors_, 0);
  prices_.transmission.assign(slot_cells.places(), 0);
  size_t entries = 0;
  offsets_.assign(static_cast<size_t>(problem.slots()) + 1, 0);
  for (int slot = 1; slot <= problem.slots(); ++slot) {
    offsets_[static_cast<size_t>(slot)] = entries;
    entries += slot_cells.At(slot).size() * sensors_ * static_cast<size_t>(Width(slot));
  }
  backward_.resize(entries);
  forward_.resize(entries);
  const auto widest = static_cast<size_t>(Width(problem.slots()));
  best_next_.resize(sensors_ * widest);
  pushed_.resize(sensors_ * widest);
  presence_cost_.resize(sensors_);
  for (const int64_t weight : problem.weights()) {
    for (size_t aoi = 1; aoi <= widest; ++aoi) {
      own_cost_.push_back(static_cast<float>(weight) * static_cast<float>(aoi));
    }
  }
}

int64_t PriceAscent::Bytes(const PlannerProblem& problem, const SlotCells& slot_cells, int aoi_limit) {
  int64_t floats = static_cast<int64_t>(slot_cells.places()) * (problem.size() + 1);
  for (int slot = 1; slot <= problem.slots(); ++slot) {
    floats += 2 * static_cast<int64_t>(slot_cells.At(slot).size()) * problem.size() * std::min(slot, aoi_limit);
  }
  return floats * static_cast<int64_t>(sizeof(float));
}

int PriceAscent::Width(int slot) const {
  return std::min(slot, aoi_limit_);
}

size_t PriceAscent::Offset(int slot, size_t number) const {
  return offsets_[static_cast<size_t>(slot)] + number * sensors_ * static_cast<size_t>(Width(slot));
}

float PriceAscent::DearShare(Move move) const {
  return problem_->IsDear(move) ? static_cast<float>(prices_.dear_slot / problem_->size()) : 0;
}

void PriceAscent::Run() {
  double before = Evaluate();
  for (int i = 0; problem_->energy_binds() && i < kSweepsBetweenChecks; ++i) {
    ImproveDearPrice();
  }
  const auto sweep_units = static_cast<int64_t>(backward_.size()) * 2 * kUnitsPerEntry;
  const int64_t most_sweeps = std::max<int64_t>(1, kMostWork / sweep_units);
  for (int64_t sweep = 1; sweep <= most_sweeps && !meter_->stopped(); ++sweep) {
    SweepForward();
    SweepBackward(true);
    if (sweep % kSweepsBetweenChecks == 0) {
      if (problem_->energy_binds()) {
        ImproveDearPrice();
      }
      const double bound = Evaluate();
      if (bound - before < kLeastGain * std::abs(bound)) {
        return;
      }
      before = bound;
    }
  }
}

double PriceAscent::Evaluate() {
  SweepBackward(false);
  double bound = -prices_.dear_slot * problem_->dear_slots();
  for (size_t n = 0; n < sensors_; ++n) {
    bound += static_cast<double>(backward_[n]);  // slot 1 has one place, and AoI 1
  }
  return bound;
}

// The bound is concave in the price of a dear slot.
void PriceAscent::ImproveDearPrice() {
  const double price = prices_.dear_slot;
  const double bound = Evaluate();
  for (const double direction : {1.0, -1.0}) {
    prices_.dear_slot = std::max(0.0, price + direction * dear_step_);
    if (prices_.dear_slot != price && Evaluate() > bound) {
      dear_step_ *= 2;
      return;
    }
  }
  prices_.dear_slot = price;
  dear_step_ /= 2;
  SweepBackward(false);
}

void PriceAscent::SweepBackward(bool reprice) {
  for (int slot = problem_->slots(); slot >= 1; --slot) {
    const std::vector<int32_t>& cells = slot_cells_->At(slot);
    for (size_t number = 0; number < cells.size(); ++number) {
      if (!meter_->Count(static_cast<int64_t>(sensors_) * Width(slot) * kUnitsPerEntry)) {
        return;
      }
      TakeBestNext(slot, cells[number]);
      if (reprice) {
        Reprice(slot, number, cells[number]);
      }
      StoreBackward(slot, number, cells[number]);
    }
  }
}

void PriceAscent::SweepForward() {
  std::fill(forward_.begin(), forward_.end(), kNever);
  std::fill_n(forward_.begin(), sensors_, 0.0f);
  for (int slot = 1; slot < problem_->slots(); ++slot) {
    const std::vector<int32_t>& cells = slot_cells_->At(slot);
    for (size_t number = 0; number < cells.size(); ++number) {
      if (!meter_->Count(static_cast<int64_t>(sensors_) * Width(slot) * kUnitsPerEntry)) {
        return;
      }
      TakeBestNext(slot, cells[number]);
      Reprice(slot, number, cells[number]);
      PushForward(slot, number, cells[number]);
    }
  }
}

// best_next_: the least backward cost in the next slot over the cells that the UAV can move to.
void PriceAscent::TakeBestNext(int slot, int cell) {
  if (slot == problem_->slots()) {
    std::fill(best_next_.begin(), best_next_.end(), 0.0f);
    return;
  }
  const size_t size = sensors_ * static_cast<size_t>(Width(slot + 1));
  std::fill_n(best_next_.begin(), size, kNever);
  for (const Move move : kAllMoves) {
    const int after = problem_->After(cell, move);
    const int number = after < 0 ? -1 : slot_cells_->Number(slot + 1, after);
    if (number < 0) {
      continue;
    }
    const float* next = backward_.data() + Offset(slot + 1, static_cast<size_t>(number));
    const float price = DearShare(move);
    for (size_t i = 0; i < size; ++i) {
      const float cost = next[i] + price;
      best_next_[i] = cost < best_next_[i] ? cost : best_next_[i];
    }
  }
}

// With `gain` what a sensor gains there by transmitting, only the one that gains most can: a price
// between the largest gain and the next one makes it so. The prices of presence then level the sensors'
// costs of the best flights through this place.
void PriceAscent::Reprice(int slot, size_t number, int cell) {
  if (slot == problem_->slots()) {
    return;  // over the stop in any case
  }
  const auto width = static_cast<size_t>(Width(slot));
  const auto next_width = static_cast<size_t>(Width(slot + 1));
  const float* forward = forward_.data() + Offset(slot, number);
  const size_t widest = own_cost_.size() / sensors_;
  float largest_gain = 0;
  float next_gain = 0;
  for (size_t n = 0; n < sensors_; ++n) {
    // pushed_: the cost up to here and of this slot.
    float* past = pushed_.data() + n * next_width;
    float least_past = kNever;
    for (size_t i = 0; i < width; ++i) {
      past[i] = forward[n * width + i] + own_cost_[n * widest + i];
    }
    const float* later = best_next_.data() + n * next_width;
    const size_t grown = std::min(width, next_width - 1);
    float unserved = LeastSum(past, later + 1, static_cast<int>(grown));
    for (size_t i = grown; i < width; ++i) {
      unserved = std::min(unserved, past[i] + later[next_width - 1]);
    }
    presence_cost_[n] = unserved;
    if (problem_->Covers(cell, static_cast<int>(n))) {
      for (size_t i = 0; i < width; ++i) {
        least_past = std::min(least_past, past[i]);
      }
      const float gain = std::max(0.0f, unserved - (least_past + later[0]));
      next_gain = std::max(next_gain, std::min(gain, largest_gain));
      largest_gain = std::max(largest_gain, gain);
      pushed_[n * next_width] = gain;  // from here on: what it gains
    } else {
      pushed_[n * next_width] = 0;
    }
  }
  const size_t place = slot_cells_->FirstPlace(slot) + number;
  const float transmission = next_gain > 0 ? (largest_gain + next_gain) / 2 : 0;
  float sum = -transmission;
  for (size_t n = 0; n < sensors_; ++n) {
    presence_cost_[n] -= std::max(0.0f, pushed_[n * next_width] - transmission);
    sum += presence_cost_[n];
  }
  prices_.transmission[place] = transmission;
  for (size_t n = 0; n < sensors_; ++n) {
    prices_.presence[place * sensors_ + n] = sum / static_cast<float>(sensors_) - presence_cost_[n];
  }
}

void PriceAscent::StoreBackward(int slot, size_t number, int cell) {
  const bool last_slot = slot == problem_->slots();
  const auto width = static_cast<size_t>(Width(slot));
  const size_t next_width = last_slot ? width : static_cast<size_t>(Width(slot + 1));
  const size_t widest = own_cost_.size() / sensors_;
  const size_t place = slot_cells_->FirstPlace(slot) + number;
  float* backward = backward_.data() + Offset(slot, number);
  for (size_t n = 0; n < sensors_; ++n) {
    const float* later = best_next_.data() + n * next_width;
    const float price = prices_.presence[place * sensors_ + n];
    const float served = !last_slot && problem_->Covers(cell, static_cast<int>(n))
                             ? later[0] + prices_.transmission[place]
                             : kNever;
    const size_t grown = std::min(width, next_width - 1);
    for (size_t i = 0; i < width; ++i) {
      const float unserved = later[i < grown ? i + 1 : next_width - 1];
      const float least = served < unserved ? served : unserved;
      backward[n * width + i] = own_cost_[n * widest + i] + price + least;
    }
  }
}

void PriceAscent::PushForward(int slot, size_t number, int cell) {
  const auto width = static_cast<size_t>(Width(slot));
  const auto next_width = static_cast<size_t>(Width(slot + 1));
  const size_t widest = own_cost_.size() / sensors_;
  const size_t place = slot_cells_->FirstPlace(slot) + number;
  const float* forward = forward_.data() + Offset(slot, number);
  for (size_t n = 0; n < sensors_; ++n) {
    float* pushed = pushed_.data() + n * next_width;
    const float price = prices_.presence[place * sensors_ + n];
    float least = kNever;
    pushed[next_width - 1] = kNever;
    for (size_t i = 0; i < width; ++i) {
      const float cost = forward[n * width + i] + own_cost_[n * widest + i] + price;
      float& target = pushed[std::min(i + 1, next_width - 1)];
      target = i + 1 < next_width ? cost : std::min(target, cost);
      least = std::min(least, cost);
    }
    const bool covered = problem_->Covers(cell, static_cast<int>(n));
    const float served = covered ? least + prices_.transmission[place] : kNever;
    pushed[0] = next_width == 1 ? std::min(pushed[0], served) : served;
  }
  for (const Move move : kAllMoves) {
    const int after = problem_->After(cell, move);
    const int next = after < 0 ? -1 : slot_cells_->Number(slot + 1, after);
    if (next < 0) {
      continue;
    }
    float* target = forward_.data() + Offset(slot + 1, static_cast<size_t>(next));
    const float price = DearShare(move);
    for (size_t i = 0; i < sensors_ * next_width; ++i) {
      const float cost = pushed_[i] + price;
      target[i] = cost < target[i] ? cost : target[i];
    }
  }
}

}  // namespace fresco
