#include "uav/lower_bound.h"

#include <algorithm>
#include <utility>

namespace fresco {
namespace {

constexpr int kMaximumPairSplits = 8;

// Rounds of a tournament: each round pairs everybody, each pair meets once. With an odd number one
// sits out each round, -1 its opponent. (The circle method: the last stays, the others rotate.)
std::vector<std::pair<int, int>> Round(int size, int round) {
  const int places = size + size % 2;
  const auto player = [&](int place) {
    const int who = place == places - 1 ? place : (place + round) % (places - 1);
    return who < size ? who : -1;
  };
  std::vector<std::pair<int, int>> pairs;
  for (int place = 0; place < places / 2; ++place) {
    pairs.emplace_back(player(place), player(places - 1 - place));
    if (pairs.back().first < 0) {
      std::swap(pairs.back().first, pairs.back().second);
    }
  }
  return pairs;
}

}  // namespace

LowerBound::LowerBound(const PlannerProblem& problem, int64_t memory_bytes) : problem_(&problem) {
  std::vector<int> singles;
  for (int sensor = 0; sensor < problem.size(); ++sensor) {
    groups_.push_back({sensor, -1});
    singles.push_back(sensor);
  }
  AddSplit(singles);
  if (SlotCells::Bytes(problem) <= memory_bytes) {
    slot_cells_ = std::make_unique<SlotCells>(problem);
    bytes_ = SlotCells::Bytes(problem);
    AddSingles(memory_bytes);
    AddPairs(memory_bytes);
  }
}

// Where the tables would not fit, the AoI is told apart less far.
void LowerBound::AddSingles(int64_t memory_bytes) {
  CostToGoOptions options;
  options.aoi_limit = problem_->maximum_aoi();
  const auto fit = [&] {
    return bytes_ + problem_->size() * CostToGo::Bytes(*problem_, *slot_cells_, options) <= memory_bytes;
  };
  while (options.aoi_limit > 1 && !fit()) {
    options.aoi_limit /= 2;
  }
  if (!fit()) {
    return;
  }
  if (problem_->energy_binds()) {
    dear_price_ = BestDearPrice(options);
  }
  options.dear_price = PriceShare(1);
  for (options.first = 0; options.first < problem_->size(); ++options.first) {
    AddTable(options);
  }
}

void LowerBound::AddPairs(int64_t memory_bytes) {
  const int rounds = std::min(problem_->size() - 1 + problem_->size() % 2, kMaximumPairSplits);
  for (int round = 0; !tables_.empty() && problem_->size() > 1 && round < rounds; ++round) {
    std::vector<int> split;
    std::vector<CostToGoOptions> pairs;
    int64_t bytes = bytes_;
    for (const auto& [first, second] : Round(problem_->size(), round)) {
      if (second < 0) {
        split.push_back(first);
        continue;
      }
      split.push_back(static_cast<int>(groups_.size() + pairs.size()));
      pairs.push_back({first, second, problem_->maximum_aoi(), PriceShare(2)});
      bytes += CostToGo::Bytes(*problem_, *slot_cells_, pairs.back());
    }
    if (bytes > memory_bytes) {
      return;
    }
    for (const CostToGoOptions& pair : pairs) {
      groups_.push_back({pair.first, pair.second});
      AddTable(pair);
    }
    AddSplit(split);
  }
}

void LowerBound::AddTable(const CostToGoOptions& options) {
  tables_.emplace_back(*problem_, *slot_cells_, options);
  bytes_ += CostToGo::Bytes(*problem_, *slot_cells_, options);
}

void LowerBound::AddSplit(std::vector<int> groups) {
  Split split{std::move(groups), std::vector<int>(static_cast<size_t>(problem_->size()))};
  for (const int group : split.groups) {
    const Group& members = groups_[static_cast<size_t>(group)];
    for (const int sensor : {members.first, members.second}) {
      if (sensor >= 0) {
        split.group_of[static_cast<size_t>(sensor)] = group;
      }
    }
  }
  splits_.push_back(std::move(split));
}

// A share in whole units for every sensor, so that every split has the same price in all.
int32_t LowerBound::PriceShare(int sensors) const {
  return static_cast<int32_t>(dear_price_ / problem_->size() * sensors);
}

int64_t LowerBound::RootBound(CostToGoOptions options, int32_t price_share) const {
  const std::vector<int16_t> aoi(static_cast<size_t>(problem_->size()), 1);
  const int start = problem_->world().CellIndex(problem_->world().scenario().start);
  options.dear_price = price_share;
  int64_t bound = -int64_t{price_share} * problem_->size() * problem_->dear_slots();
  for (options.first = 0; options.first < problem_->size(); ++options.first) {
    const CostToGo table(*problem_, *slot_cells_, options);
    bound += table.At(table.PlaceOf(1, slot_cells_->Number(1, start)), aoi.data());
  }
  return bound;
}

// Pricing dear slots instead of forbidding too many of them (Lagrange): the bound is concave in the
// price, so doubling finds where it stops to rise and halving the best price in between.
int64_t LowerBound::BestDearPrice(const CostToGoOptions& options) const {
  constexpr int32_t kLargestShare = 1 << 12;
  int32_t best = 0;
  int64_t best_bound = RootBound(options, 0);
  for (int32_t step = 1; step > 0;) {
    const int64_t bound = RootBound(options, best + step);
    if (bound > best_bound && best + step <= kLargestShare) {
      best_bound = bound;
      best += step;
      step *= 2;
    } else {
      step /= 2;
    }
  }
  return int64_t{best} * problem_->size();
}

LowerBound::OverCell::OverCell(const LowerBound& bound, int slot, int cell)
    : bound_(&bound),
      slots_left_(bound.problem_->slots() - slot),
      values_(bound.groups_.size()),
      sums_(bound.splits_.size()) {
  for (const CostToGo& table : bound.tables_) {
    places_.push_back(table.PlaceOf(slot, bound.slot_cells_->Number(slot, cell)));
  }
}

int64_t LowerBound::OverCell::operator()(const int16_t* aoi, int dear) {
  for (size_t group = 0; group < places_.size(); ++group) {
    values_[group] = bound_->tables_[group].At(places_[group], aoi);
  }
  const PlannerProblem& problem = *bound_->problem_;
  for (size_t n = 0; places_.empty() && n < values_.size(); ++n) {
    values_[n] = int64_t{problem.weights()[n]} * (aoi[n] + slots_left_);  // served in every slot
  }
  for (size_t split = 0; split < sums_.size(); ++split) {
    sums_[split] = 0;
    for (const int group : bound_->splits_[split].groups) {
      sums_[split] += values_[static_cast<size_t>(group)];
    }
  }
  rebate_ = bound_->dear_price_ * (problem.dear_slots() - dear);
  return *std::max_element(sums_.begin(), sums_.end()) - rebate_;
}

int64_t LowerBound::OverCell::WithoutSensor(int sensor) const {
  int64_t largest = 0;
  for (size_t split = 0; split < sums_.size(); ++split) {
    const auto group = static_cast<size_t>(bound_->splits_[split].group_of[static_cast<size_t>(sensor)]);
    const auto [first, second] = bound_->groups_[group];
    const int mate = first == sensor ? second : first;
    const int64_t mate_alone = mate < 0 ? 0 : values_[static_cast<size_t>(mate)];
    largest = std::max(largest, sums_[split] - values_[group] + mate_alone);
  }
  return largest - rebate_;
}

}  // namespace fresco
