#include "planner/lower_bound.h"

#include <algorithm>
#include <cmath>

#include "planner/price_ascent.h"

namespace fresco {
namespace {

// These limits let a table's largest value fit an int32_t: costs up to 2^28, prices of dear slots up to 2^28,
// prices of places up to 2^30.
constexpr double kLargestTableCost = 1 << 28;
constexpr double kLargestPriceSum = 1 << 30;

TableUnits ChooseUnits(const PlannerProblem& problem) {
  constexpr int kLargestShift = 6;  // prices in 64ths of a unit of cost are fine enough
  const int64_t largest = *std::max_element(problem.weights().begin(), problem.weights().end());
  const double slots = problem.slots();
  const double cost = static_cast<double>(largest) * slots * (slots + 1) / 2;
  return {std::min(kLargestShift, static_cast<int>(std::floor(std::log2(kLargestTableCost / cost))))};
}

// Rounds the presence prices of all sensors and the transmission price of one place so that they sum to zero.
// If a price would be too large, all are zero.
void Round(const float* presence, float transmission, size_t sensors, double scale, double largest,
           int32_t* whole_presence, int32_t* whole_transmission) {
  const double transmission_value = std::floor(transmission * scale);
  double sum = transmission_value;
  bool fits = transmission_value <= largest;
  for (size_t n = 0; n < sensors; ++n) {
    const double value = n + 1 < sensors ? std::floor(presence[n] * scale) : -sum;
    sum += value;
    fits = fits && std::abs(value) <= largest;
    whole_presence[n] = fits ? static_cast<int32_t>(value) : 0;
  }
  *whole_transmission = fits ? static_cast<int32_t>(transmission_value) : 0;
  if (!fits) {
    std::fill_n(whole_presence, sensors, 0);
  }
}

WholePrices ToWhole(const CellPrices& prices, const PlannerProblem& problem, TableUnits units,
                    WorkMeter& meter) {
  const auto sensors = static_cast<size_t>(problem.size());
  const double scale = std::ldexp(1.0, units.shift);
  const double largest = std::floor(kLargestPriceSum / 2 / problem.slots());
  WholePrices whole{std::vector<int32_t>(prices.presence.size()),
                    std::vector<int32_t>(prices.transmission.size())};
  constexpr int64_t kUnitsPerPrice = 16;
  const int64_t place_units = problem.size() * kUnitsPerPrice;
  for (size_t place = 0; place < prices.transmission.size() && meter.Count(place_units); ++place) {
    Round(prices.presence.data() + place * sensors, prices.transmission[place], sensors, scale, largest,
          whole.presence.data() + place * sensors, &whole.transmission[place]);
  }
  const double dear_share = prices.dear_slot / problem.size() * scale;
  whole.dear_share = static_cast<int32_t>(std::min(dear_share, kLargestTableCost / problem.slots()));
  return whole;
}

}  // namespace

LowerBound::LowerBound(const PlannerProblem& problem, int64_t memory_bytes, WorkMeter& meter)
    : problem_(&problem), units_(ChooseUnits(problem)), aoi_limit_(problem.maximum_aoi()) {
  bytes_ = SlotCells::Bytes(problem);
  if (bytes_ <= memory_bytes) {
    slot_cells_ = std::make_unique<SlotCells>(problem, meter);
    if (!meter.stopped() && ChooseSizes(memory_bytes)) {
      AddTables(meter);
    }
  }
  if (meter.stopped()) {
    tables_.clear();
  }
  if (tables_.empty()) {
    slot_cells_.reset();
    bytes_ = 0;
  }
}

// Makes the tables smaller until they fit: first they lose the AoI below 1, then the limit of the AoI is
// halved again and again. Returns whether they fit.
bool LowerBound::ChooseSizes(int64_t memory_bytes) {
  lowest_aoi_ = problem_->is_capped() ? 1 : 1 - problem_->slots();
  if (BytesToBuild() > memory_bytes) {
    lowest_aoi_ = 1;
  }
  while (aoi_limit_ > 1 && BytesToBuild() > memory_bytes) {
    aoi_limit_ /= 2;
  }
  return BytesToBuild() <= memory_bytes;
}

CostToGoOptions LowerBound::TableOptions(int sensor) const {
  const int64_t weight = units_.Weight(problem_->weights()[static_cast<size_t>(sensor)]);
  return {sensor, static_cast<int32_t>(weight), aoi_limit_, lowest_aoi_};
}

int64_t LowerBound::TableBytes() const {
  return problem_->size() * CostToGo::Bytes(*problem_, *slot_cells_, TableOptions(0));
}

int64_t LowerBound::BytesToBuild() const {
  const int64_t price_bytes = static_cast<int64_t>(slot_cells_->places()) * (problem_->size() + 1) *
                              static_cast<int64_t>(sizeof(int32_t));
  return SlotCells::Bytes(*problem_) +
         std::max(PriceAscent::Bytes(*problem_, *slot_cells_, aoi_limit_) + price_bytes,
                  TableBytes() + price_bytes);
}

void LowerBound::AddTables(WorkMeter& meter) {
  WholePrices prices;
  {
    PriceAscent ascent(*problem_, *slot_cells_, aoi_limit_, meter);
    ascent.Run();
    prices = ToWhole(ascent.prices(), *problem_, units_, meter);
  }
  dear_price_ = int64_t{prices.dear_share} * problem_->size();
  bytes_ += TableBytes();
  for (int sensor = 0; sensor < problem_->size() && !meter.stopped(); ++sensor) {
    tables_.emplace_back(*problem_, *slot_cells_, prices, TableOptions(sensor), meter);
  }
}

int64_t LowerBound::OfAnyFlight() const {
  const std::vector<int16_t> aoi(static_cast<size_t>(problem_->size()), 1);
  return OverCell(*this, 1, problem_->start())(aoi.data(), 0);
}

LowerBound::OverCell::OverCell(const LowerBound& bound, int slot, int cell)
    : bound_(&bound),
      slots_left_(bound.problem_->slots() - slot + 1),
      values_(static_cast<size_t>(bound.problem_->size())) {
  for (const CostToGo& table : bound.tables_) {
    places_.push_back(table.PlaceOf(slot, bound.slot_cells_->Number(slot, cell)));
  }
}

int64_t LowerBound::OverCell::operator()(const int16_t* aoi, int dear) {
  const PlannerProblem& problem = *bound_->problem_;
  if (places_.empty()) {
    int64_t cost = 0;
    for (size_t n = 0; n < values_.size(); ++n) {
      cost += problem.weights()[n] * (aoi[n] + slots_left_ - 1);  // served in every slot
    }
    return cost;
  }
  sum_ = -bound_->dear_price_ * (problem.dear_slots() - dear);
  for (size_t n = 0; n < places_.size(); ++n) {
    values_[n] = places_[n].At(aoi[n]);
    sum_ += values_[n];
  }
  return bound_->units_.CostOf(sum_);
}

// Let C be the sensor's least cost, at its prices, among the flights from here that leave it unserved for k
// slots or more. If its AoI were lower by d, the same flight would cost at most C - k weight d, but not less
// than the table's optimum for that lower AoI. So C is at least that optimum plus k weight d, and a C that
// may not exceed `most` limits k.
int LowerBound::OverCell::LongestUnserved(int sensor, int aoi, int64_t limit) const {
  const auto n = static_cast<size_t>(sensor);
  const int64_t weight = bound_->units_.Weight(bound_->problem_->weights()[n]);
  const bool aoi_grows_in_tables = bound_->aoi_limit_ == bound_->problem_->slots();
  if (places_.empty() || !aoi_grows_in_tables || weight == 0) {
    return slots_left_;
  }
  const CostToGo::Place& place = places_[n];
  const int64_t most = bound_->units_.ValueOf(limit) - 1 - (sum_ - values_[n]);  // the most that the sensor
                                                                                 // may cost
  double longest = slots_left_;
  for (int lower = 1; aoi - lower >= place.lowest_aoi; lower *= 2) {
    // Rounding in double never takes a quotient below the largest whole number that it reaches.
    const auto saved = static_cast<double>(weight * lower);
    longest = std::min(longest, static_cast<double>(most - place.At(aoi - lower)) / saved);
  }
  return static_cast<int>(longest);
}

}  // namespace fresco
