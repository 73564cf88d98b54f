#include "planner/price_ascent.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fresco {
namespace {

constexpr float kNoFlight = 1e30f;
constexpr int kSweepsBetweenChecks = 8;
constexpr double kLeastGain = 0.01;  // stop if kSweepsBetweenChecks sweeps raise the bound by less
constexpr int64_t kMostWork = int64_t{1} << 34;
constexpr int64_t kUnitsPerEntry = 12;  // work of a sweep in one direction

// The smaller value, in a form that gcc turns into vector instructions. With std::min, which takes
// references, it does not.
inline float Less(float a, float b) {
  return a < b ? a : b;
}

// Returns the least of value(0) .. value(size - 1). Works in lanes, since the compiler may not reorder a
// minimum of floats by itself.
template <class Value>
float Least(size_t size, const Value& value) {
  constexpr size_t kLanes = 8;
  float lanes[kLanes];
  std::fill_n(lanes, kLanes, kNoFlight);
  size_t begin = 0;
  for (; begin + kLanes <= size; begin += kLanes) {
    for (size_t i = 0; i < kLanes; ++i) {
      lanes[i] = Less(value(begin + i), lanes[i]);
    }
  }
  for (size_t i = 0; begin + i < size; ++i) {
    lanes[i] = Less(value(begin + i), lanes[i]);
  }
  return *std::min_element(lanes, lanes + kLanes);
}

}  // namespace

PriceAscent::PriceAscent(const PlannerProblem& problem, const SlotCells& slot_cells, int aoi_limit,
                         WorkMeter& meter)
    : problem_(&problem),
      slot_cells_(&slot_cells),
      aoi_limit_(aoi_limit),
      meter_(&meter),
      sensors_(static_cast<size_t>(problem.size())),
      widest_(static_cast<size_t>(Width(problem.slots()))),
      dear_step_(static_cast<double>(*std::max_element(problem.weights().begin(), problem.weights().end())) /
                 4) {
  prices_.presence.assign(slot_cells.places() * sensors_, 0);
  prices_.transmission.assign(slot_cells.places(), 0);
  offsets_.assign(static_cast<size_t>(problem.slots()) + 1, 0);
  for (int slot = 1; slot <= problem.slots(); ++slot) {
    offsets_[static_cast<size_t>(slot)] = entries_;
    entries_ += slot_cells.At(slot).size() * sensors_ * static_cast<size_t>(Width(slot));
  }
  // Left uninitialised: setting gigabytes to zero takes long, and the meter would not be asked meanwhile.
  backward_ = std::make_unique_for_overwrite<float[]>(entries_);
  forward_ = std::make_unique_for_overwrite<float[]>(entries_);
  best_next_.resize(sensors_ * widest_);
  pushed_.resize(sensors_ * widest_);
  past_.resize(widest_);
  marginals_.resize(sensors_);
  for (const int64_t weight : problem.weights()) {
    for (size_t aoi = 1; aoi <= widest_; ++aoi) {
      own_cost_.push_back(static_cast<float>(weight) * static_cast<float>(aoi));
    }
  }
}

int64_t PriceAscent::Bytes(const PlannerProblem& problem, const SlotCells& slot_cells, int aoi_limit) {
  int64_t floats = static_cast<int64_t>(slot_cells.places()) * (problem.size() + 1);
  for (int slot = 1; slot <= problem.slots(); ++slot) {
    floats +=
        2 * static_cast<int64_t>(slot_cells.At(slot).size()) * problem.size() * std::min(slot, aoi_limit);
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
  const auto sweep_units = static_cast<int64_t>(entries_) * 2 * kUnitsPerEntry;
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
    bound += static_cast<double>(backward_[n]);  // slot 1 has one place and one AoI, 1
  }
  return bound;
}

// The bound is a concave function of the price of a dear slot. So go up or down in steps that double as long
// as they raise the bound.
void PriceAscent::ImproveDearPrice() {
  double bound = Evaluate();
  for (const double direction : {1.0, -1.0}) {
    const double first_price = prices_.dear_slot;
    for (double step = dear_step_; !meter_->stopped(); step *= 2) {
      const double price = prices_.dear_slot;
      prices_.dear_slot = std::max(0.0, price + direction * step);
      const double next_bound = prices_.dear_slot == price ? bound : Evaluate();
      if (next_bound <= bound) {
        prices_.dear_slot = price;
        break;
      }
      bound = next_bound;
    }
    if (prices_.dear_slot != first_price) {
      break;
    }
  }
  SweepBackward(false);
}

void PriceAscent::SweepBackward(bool reprice) {
  for (int slot = problem_->slots(); slot >= 1; --slot) {
    const std::vector<int32_t>& cells = slot_cells_->At(slot);
    for (size_t number = 0; number < cells.size(); ++number) {
      if (!meter_->Count(static_cast<int64_t>(sensors_) * Width(slot) * kUnitsPerEntry)) {
        return;
      }
      ComputeBestNext(slot, cells[number]);
      if (reprice) {
        Reprice(slot, number, cells[number]);
      }
      StoreBackward(slot, number, cells[number]);
    }
  }
}

void PriceAscent::SweepForward() {
  std::fill_n(forward_.get(), sensors_, 0.0f);  // slot 1 has one place and one AoI, 1
  for (int slot = 1; slot < problem_->slots(); ++slot) {
    const std::vector<int32_t>& cells = slot_cells_->At(slot);
    const size_t next_size =
        slot_cells_->At(slot + 1).size() * sensors_ * static_cast<size_t>(Width(slot + 1));
    std::fill_n(forward_.get() + Offset(slot + 1, 0), next_size, kNoFlight);
    for (size_t number = 0; number < cells.size(); ++number) {
      if (!meter_->Count(static_cast<int64_t>(sensors_) * Width(slot) * kUnitsPerEntry)) {
        return;
      }
      ComputeBestNext(slot, cells[number]);
      Reprice(slot, number, cells[number]);
      PushForward(slot, number, cells[number]);
    }
  }
}

// Writes to best_next_ the least backward cost in the next slot over the cells that the UAV can move to.
void PriceAscent::ComputeBestNext(int slot, int cell) {
  if (slot == problem_->slots()) {
    std::fill(best_next_.begin(), best_next_.end(), 0.0f);
    return;
  }
  // Handles five neighbours at a time. If there are fewer, the first one fills the gaps.
  std::array<const float*, kMoves> next;
  std::array<float, kMoves> price;
  size_t count = 0;
  for (const Move move : kAllMoves) {
    const int after = problem_->After(cell, move);
    const int number = after < 0 ? -1 : slot_cells_->Number(slot + 1, after);
    if (number >= 0) {
      next[count] = backward_.get() + Offset(slot + 1, static_cast<size_t>(number));
      price[count++] = DearShare(move);
    }
  }
  for (size_t i = count; i < kMoves; ++i) {
    next[i] = next[0];
    price[i] = price[0];
  }
  const size_t size = sensors_ * static_cast<size_t>(Width(slot + 1));
  float* best = best_next_.data();
  for (size_t i = 0; i < size; ++i) {
    const float first = Less(next[0][i] + price[0], next[1][i] + price[1]);
    const float second = Less(next[2][i] + price[2], next[3][i] + price[3]);
    best[i] = Less(Less(first, second), next[4][i] + price[4]);
  }
}

// Computes the cost of one sensor's best flight through a place that does not serve it there, and what it
// gains by being served there. Overwrites past_.
PriceAscent::Marginals PriceAscent::MarginalsOf(size_t sensor, const float* forward, int slot, bool covered) {
  const auto width = static_cast<size_t>(Width(slot));
  const auto next_width = static_cast<size_t>(Width(slot + 1));
  const float* own_cost = own_cost_.data() + sensor * widest_;
  const float* later = best_next_.data() + sensor * next_width;
  for (size_t i = 0; i < width; ++i) {
    past_[i] = forward[i] + own_cost[i];
  }
  const size_t growing = std::min(width, next_width - 1);
  Marginals marginals{Least(growing, [&](size_t i) { return past_[i] + later[i + 1]; }), 0};
  if (growing < width) {
    marginals.unserved = std::min(marginals.unserved, past_[growing] + later[growing]);
  }
  if (covered) {
    const float served = Least(width, [&](size_t i) { return past_[i]; }) + later[0];
    marginals.gain = std::max(0.0f, marginals.unserved - served);
  }
  return marginals;
}

// Several sensors may gain by transmitting at a place, but only one can. A price between the largest gain and
// the next one lets only the sensor with the largest gain want it. The presence prices then make the sensors'
// costs equal.
void PriceAscent::Reprice(int slot, size_t number, int cell) {
  if (slot == problem_->slots()) {
    return;  // in the last slot all flights are over the stop
  }
  float largest_gain = 0;
  float next_gain = 0;
  for (size_t n = 0; n < sensors_; ++n) {
    const float* forward = forward_.get() + Offset(slot, number) + n * static_cast<size_t>(Width(slot));
    marginals_[n] = MarginalsOf(n, forward, slot, problem_->Covers(cell, static_cast<int>(n)));
    next_gain = std::max(next_gain, std::min(marginals_[n].gain, largest_gain));
    largest_gain = std::max(largest_gain, marginals_[n].gain);
  }
  const size_t place = slot_cells_->FirstPlace(slot) + number;
  const float transmission = next_gain > 0 ? (largest_gain + next_gain) / 2 : 0;
  prices_.transmission[place] = transmission;
  float sum = -transmission;
  float* presence = prices_.presence.data() + place * sensors_;
  for (size_t n = 0; n < sensors_; ++n) {
    presence[n] = std::max(0.0f, marginals_[n].gain - transmission) - marginals_[n].unserved;
    sum -= presence[n];
  }
  for (size_t n = 0; n < sensors_; ++n) {
    presence[n] += sum / static_cast<float>(sensors_);
  }
}

void PriceAscent::StoreBackward(int slot, size_t number, int cell) {
  const bool last_slot = slot == problem_->slots();
  const auto width = static_cast<size_t>(Width(slot));
  const size_t next_width = last_slot ? width : static_cast<size_t>(Width(slot + 1));
  const size_t growing = std::min(width, next_width - 1);
  const size_t place = slot_cells_->FirstPlace(slot) + number;
  for (size_t n = 0; n < sensors_; ++n) {
    const float* later = best_next_.data() + n * next_width;
    const float* own_cost = own_cost_.data() + n * widest_;
    const float price = prices_.presence[place * sensors_ + n];
    const bool covered = !last_slot && problem_->Covers(cell, static_cast<int>(n));
    const float served = covered ? later[0] + prices_.transmission[place] : kNoFlight;
    float* backward = backward_.get() + Offset(slot, number) + n * width;
    for (size_t i = 0; i < growing; ++i) {
      backward[i] = own_cost[i] + price + Less(served, later[i + 1]);
    }
    if (growing < width) {
      backward[growing] = own_cost[growing] + price + Less(served, later[growing]);
    }
  }
}

void PriceAscent::PushForward(int slot, size_t number, int cell) {
  const auto width = static_cast<size_t>(Width(slot));
  const auto next_width = static_cast<size_t>(Width(slot + 1));
  const size_t growing = std::min(width, next_width - 1);
  const size_t place = slot_cells_->FirstPlace(slot) + number;
  for (size_t n = 0; n < sensors_; ++n) {
    const float* forward = forward_.get() + Offset(slot, number) + n * width;
    const float* own_cost = own_cost_.data() + n * widest_;
    const float price = prices_.presence[place * sensors_ + n];
    for (size_t i = 0; i < width; ++i) {
      past_[i] = forward[i] + own_cost[i] + price;
    }
    float* pushed = pushed_.data() + n * next_width;
    pushed[0] = kNoFlight;
    std::copy_n(past_.begin(), growing, pushed + 1);
    if (growing < width) {
      pushed[growing] = std::min(pushed[growing], past_[growing]);  // it grows no further
    }
    if (problem_->Covers(cell, static_cast<int>(n))) {
      const float least = Least(width, [&](size_t i) { return past_[i]; });
      pushed[0] = std::min(pushed[0], least + prices_.transmission[place]);
    }
  }
  for (const Move move : kAllMoves) {
    const int after = problem_->After(cell, move);
    const int next = after < 0 ? -1 : slot_cells_->Number(slot + 1, after);
    if (next < 0) {
      continue;
    }
    float* target = forward_.get() + Offset(slot + 1, static_cast<size_t>(next));
    const float price = DearShare(move);
    for (size_t i = 0; i < sensors_ * next_width; ++i) {
      target[i] = Less(pushed_[i] + price, target[i]);
    }
  }
}

}  // namespace fresco
