#include "uav/label_search.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "core/check.h"

namespace fresco {
namespace {

constexpr Move kAllMoves[] = {Move::kNorth, Move::kSouth, Move::kEast, Move::kWest, Move::kHover};

/// How a label came to be: from which label of the slot before, by which action.
struct Trail {
  uint32_t parent = 0;
  int16_t schedule = 0;
  Move move = Move::kHover;
};

/// Labels of one slot, those over one cell side by side.
struct Labels {
  struct Range {
    int32_t cell;
    size_t begin;
    size_t end;
  };
  std::vector<Range> ranges;  // by cell, ascending
  std::vector<int64_t> cost;  // of the slots before this one
  std::vector<int64_t> bound;
  std::vector<int32_t> dear;  // dear slots so far
  std::vector<int64_t> least;  // Dominance::LeastCost
  std::vector<int16_t> aoi;    // one entry a sensor
  std::vector<Trail> trails;

  size_t size() const { return cost.size(); }
  void Clear() {
    ranges.clear();
    cost.clear();
    bound.clear();
    dear.clear();
    least.clear();
    aoi.clear();
    trails.clear();
  }
  void Append(const Labels& from, size_t index, size_t sensors) {
    cost.push_back(from.cost[index]);
    bound.push_back(from.bound[index]);
    dear.push_back(from.dear[index]);
    least.push_back(from.least[index]);
    const int16_t* values = from.aoi.data() + index * sensors;
    aoi.insert(aoi.end(), values, values + sensors);
    trails.push_back(from.trails[index]);
  }
};

/// Which labels over one cell another one beats: flying on as the other one does, it never costs more.
/// Each sensor's difference in AoI counts in every slot until the sensor is served: at least until it
/// can be covered, at most until the other label could no longer lead to a flight below the limit.
class Dominance {
 public:
  Dominance(const PlannerProblem& problem, int slot, const int* distances)
      : weights_(problem.weights()), slots_left_(problem.slots() - slot + 1) {
    const auto cells = static_cast<size_t>(problem.cells());
    for (size_t n = 0; n < weights_.size(); ++n) {
      // Where the AoI is capped an advantage may vanish before the sensor is served.
      const bool capped = problem.maximum_aoi() < problem.slots();
      shortest_.push_back(capped ? 0 : std::min(distances[n * cells] + 1, slots_left_));
    }
  }

  /// The label's cost, were every sensor served as soon as it can be covered, but for terms that all
  /// labels share. One label beats another only where this is not larger.
  int64_t LeastCost(int64_t cost, const int16_t* aoi) const {
    for (size_t n = 0; n < weights_.size(); ++n) {
      cost += int64_t{weights_[n]} * shortest_[n] * aoi[n];
    }
    return cost;
  }

  /// In how many slots from this one on a sensor's AoI can stay unserved in a flight that keeps below
  /// `budget`, the cost of this sensor alone; -1 where even the first one takes it beyond.
  int LongestUnserved(size_t n, int aoi, int64_t budget) const {
    if (shortest_[n] == 0) {
      return slots_left_;
    }
    // aoi, aoi + 1, ... while unserved, at least 1 a slot afterwards.
    const auto cost = [&](int64_t slots) {
      return weights_[n] * (aoi * slots + slots * (slots - 1) / 2 + slots_left_ - slots);
    };
    int low = -1;
    for (int high = slots_left_ + 1; high - low > 1;) {
      const int middle = (low + high) / 2;
      (cost(middle) < budget ? low : high) = middle;
    }
    return low;
  }

  int shortest(size_t n) const { return shortest_[n]; }

 private:
  const std::vector<int32_t>& weights_;
  int slots_left_;             // this one included
  std::vector<int> shortest_;  // slots until a sensor can have been served
};

/// The labels over one cell that were kept, laid out so that one candidate is held against many of them
/// at a time. All numbers are whole and far below 2^53, so double is exact.
class Undominated {
 public:
  Undominated(size_t sensors, bool energy_binds) : energy_binds_(energy_binds), aoi_(sensors) {}

  void Clear() {
    size_ = 0;
    least_.clear();
    dear_.clear();
    for (std::vector<double>& values : aoi_) {
      values.clear();
    }
  }

  void Add(int64_t least, int dear, const int16_t* aoi) {
    if (size_ % kLanes == 0) {
      least_.resize(size_ + kLanes, kNever);
      dear_.resize(size_ + kLanes, 0);
      for (std::vector<double>& values : aoi_) {
        values.resize(size_ + kLanes, 0);
      }
    }
    least_[size_] = static_cast<double>(least);
    dear_[size_] = dear;
    for (size_t n = 0; n < aoi_.size(); ++n) {
      aoi_[n][size_] = aoi[n];
    }
    ++size_;
  }

  /// Whether one of the labels beats a candidate. None of them has a larger LeastCost. `gaps`: by
  /// sensor, what one slot of AoI more may cost beyond LeastCost's share until the sensor is served.
  bool Beat(int64_t least, int dear, const int16_t* aoi, const double* gaps) const {
    for (size_t begin = 0; begin < size_; begin += kLanes) {
      std::array<double, kLanes> excess;
      for (size_t i = 0; i < kLanes; ++i) {
        excess[i] = least_[begin + i] - static_cast<double>(least);
      }
      for (size_t n = 0; n < aoi_.size(); ++n) {
        const double* older = aoi_[n].data() + begin;
        for (size_t i = 0; i < kLanes; ++i) {
          excess[i] += gaps[n] * std::max(0.0, older[i] - aoi[n]);
        }
      }
      for (size_t i = 0; energy_binds_ && i < kLanes; ++i) {
        excess[i] += dear_[begin + i] > dear ? kNever : 0;
      }
      if (*std::min_element(excess.begin(), excess.end()) <= 0) {
        return true;
      }
    }
    return false;
  }

 private:
  static constexpr size_t kLanes = 16;
  static constexpr double kNever = 1e300;

  bool energy_binds_;
  size_t size_ = 0;
  std::vector<double> least_;  // each up to a multiple of kLanes, those beyond size_ beating nothing
  std::vector<double> dear_;
  std::vector<std::vector<double>> aoi_;  // by sensor
};

class Search {
 public:
  Search(const PlannerProblem& problem, const LowerBound& lower_bound, int64_t limit, int64_t width)
      : problem_(problem),
        lower_bound_(lower_bound),
        limit_(limit),
        width_(static_cast<size_t>(width)),
        sensors_(static_cast<size_t>(problem.size())),
        range_of_cell_(static_cast<size_t>(problem.cells()), -1),
        distances_(sensors_ * static_cast<size_t>(problem.cells())),
        child_aoi_(sensors_),
        undominated_(sensors_, problem.energy_binds()) {
    MeasureDistances();
  }

  LabelSearchResult Run(const KeepGoing& keep_going);

 private:
  void MeasureDistances();
  void Begin();
  std::vector<int32_t> NextCells() const;
  void FindRanges();
  void Generate(int slot, int32_t cell);
  void Branch(size_t parent, int dear, int32_t from, Move move, const Dominance& dominance,
              LowerBound::OverCell& bound);
  void AddChild(size_t parent, int64_t cost, int dear, int schedule, Move move, const Dominance& dominance,
                LowerBound::OverCell& bound);
  void KeepUndominated(int32_t cell);
  void DropLeastPromising();
  void TakeBestFlight();

  const PlannerProblem& problem_;
  const LowerBound& lower_bound_;
  int64_t limit_;
  size_t width_;
  size_t sensors_;
  Labels labels_;      // of the present slot
  Labels next_;        // of the next slot
  Labels candidates_;  // of the next slot over one cell
  std::vector<double> gaps_;  // of the candidates, by sensor: weight x slots for which a lead may last
  std::vector<int32_t> range_of_cell_;
  std::vector<int> distances_;  // by sensor and cell: moves until it is covered
  std::vector<int16_t> child_aoi_;
  Undominated undominated_;
  std::vector<size_t> order_;
  std::vector<std::vector<Trail>> history_;  // by slot - 1
  LabelSearchResult result_;
};

// Manhattan distances to the coverage of every sensor, by sweeps (as flights may go anywhere on the
// grid, they are exact).
void Search::MeasureDistances() {
  const int cells = problem_.cells();
  const int far = problem_.slots();
  for (int sensor = 0; sensor < problem_.size(); ++sensor) {
    int* distance = distances_.data() + sensor * cells;
    std::vector<int> front;
    for (int cell = 0; cell < cells; ++cell) {
      distance[cell] = problem_.Covers(cell, sensor) ? 0 : far;
      if (distance[cell] == 0) {
        front.push_back(cell);
      }
    }
    for (size_t i = 0; i < front.size(); ++i) {
      for (const Move move : kAllMoves) {
        const int after = problem_.After(front[i], move);
        if (after >= 0 && distance[after] > distance[front[i]] + 1) {
          distance[after] = distance[front[i]] + 1;
          front.push_back(after);
        }
      }
    }
  }
}

LabelSearchResult Search::Run(const KeepGoing& keep_going) {
  Begin();
  for (int slot = 1; slot < problem_.slots(); ++slot) {
    next_.Clear();
    FindRanges();
    for (const int32_t cell : NextCells()) {
      Generate(slot, cell);
      KeepUndominated(cell);
    }
    DropLeastPromising();
    std::swap(labels_, next_);
    history_.push_back(std::move(labels_.trails));
    result_.labels += static_cast<int64_t>(labels_.size());
    if (labels_.size() == 0) {
      return result_;
    }
    const int64_t least_bound = *std::min_element(labels_.bound.begin(), labels_.bound.end());
    if (!keep_going(slot + 1, static_cast<int64_t>(labels_.size()), least_bound)) {
      result_.stopped = true;
      result_.least_dropped = std::min(result_.least_dropped, least_bound);
      return result_;
    }
  }
  TakeBestFlight();
  return result_;
}

void Search::Begin() {
  const int start = problem_.world().CellIndex(problem_.world().scenario().start);
  labels_.cost = {0};
  labels_.dear = {0};
  labels_.least = {0};
  labels_.aoi.assign(sensors_, 1);
  labels_.bound = {LowerBound::OverCell(lower_bound_, 1, start)(labels_.aoi.data(), 0)};
  labels_.trails = {Trail{}};
  labels_.ranges = {{start, 0, 1}};
  history_ = {labels_.trails};
}

void Search::FindRanges() {
  std::fill(range_of_cell_.begin(), range_of_cell_.end(), -1);
  for (size_t i = 0; i < labels_.ranges.size(); ++i) {
    range_of_cell_[static_cast<size_t>(labels_.ranges[i].cell)] = static_cast<int32_t>(i);
  }
}

std::vector<int32_t> Search::NextCells() const {
  std::vector<int32_t> cells;
  for (const Labels::Range& range : labels_.ranges) {
    for (const Move move : kAllMoves) {
      const int after = problem_.After(range.cell, move);
      if (after >= 0) {
        cells.push_back(after);
      }
    }
  }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

/// All children over `cell` at the beginning of slot + 1, from the labels over it and its neighbours.
void Search::Generate(int slot, int32_t cell) {
  candidates_.Clear();
  gaps_.clear();
  const int allowance = problem_.DearAllowance(slot + 1, cell);
  if (allowance < 0) {
    return;
  }
  LowerBound::OverCell bound(lower_bound_, slot + 1, cell);
  const Dominance dominance(problem_, slot + 1, distances_.data() + cell);
  for (const Move move : kAllMoves) {
    // The cell from which the move leads here is where the opposite move leads.
    static constexpr Move kOpposite[] = {Move::kSouth, Move::kNorth, Move::kWest, Move::kEast, Move::kHover};
    const int from = problem_.After(cell, kOpposite[static_cast<int>(move)]);
    const int32_t range = from < 0 ? -1 : range_of_cell_[static_cast<size_t>(from)];
    if (range < 0) {
      continue;
    }
    const Labels::Range& labels = labels_.ranges[static_cast<size_t>(range)];
    for (size_t parent = labels.begin; parent < labels.end; ++parent) {
      const int dear = labels_.dear[parent] + (problem_.energy_binds() && problem_.IsDear(move) ? 1 : 0);
      if (dear <= allowance) {
        Branch(parent, dear, from, move, dominance, bound);
      }
    }
  }
}

/// One child for each covered sensor that may transmit, or one where none is covered: serving a sensor
/// is never worse than serving none.
void Search::Branch(size_t parent, int dear, int32_t from, Move move, const Dominance& dominance,
                    LowerBound::OverCell& bound) {
  const int16_t* aoi = labels_.aoi.data() + parent * sensors_;
  int64_t cost = labels_.cost[parent];
  for (size_t n = 0; n < sensors_; ++n) {
    cost += int64_t{problem_.weights()[n]} * aoi[n];
    child_aoi_[n] = static_cast<int16_t>(problem_.NextAoi(aoi[n]));
  }
  bool served = false;
  for (size_t n = 0; n < sensors_; ++n) {
    if (problem_.Covers(from, static_cast<int>(n))) {
      const int16_t unserved = std::exchange(child_aoi_[n], int16_t{1});
      AddChild(parent, cost, dear, static_cast<int>(n) + 1, move, dominance, bound);
      child_aoi_[n] = unserved;
      served = true;
    }
  }
  if (!served) {
    AddChild(parent, cost, dear, 0, move, dominance, bound);
  }
}

void Search::AddChild(size_t parent, int64_t cost, int dear, int schedule, Move move,
                      const Dominance& dominance, LowerBound::OverCell& bound) {
  // A child's bound is its parent's at least.
  const int64_t least = std::max(labels_.bound[parent], cost + bound(child_aoi_.data(), dear));
  if (least >= limit_) {
    return;
  }
  const size_t gap = gaps_.size();
  gaps_.resize(gap + sensors_, 0);
  for (size_t n = 0; n < sensors_; ++n) {
    const int longest =
        dominance.LongestUnserved(n, child_aoi_[n], limit_ - cost - bound.WithoutSensor(static_cast<int>(n)));
    if (longest < dominance.shortest(n)) {
      gaps_.resize(gap);
      return;  // it can't be served in time for a flight below the limit
    }
    gaps_[gap + n] = problem_.weights()[n] * (longest - dominance.shortest(n));
  }
  candidates_.cost.push_back(cost);
  candidates_.bound.push_back(least);
  candidates_.dear.push_back(dear);
  candidates_.least.push_back(dominance.LeastCost(cost, child_aoi_.data()));
  candidates_.aoi.insert(candidates_.aoi.end(), child_aoi_.begin(), child_aoi_.end());
  candidates_.trails.push_back({static_cast<uint32_t>(parent), static_cast<int16_t>(schedule), move});
}

void Search::KeepUndominated(int32_t cell) {
  if (candidates_.size() == 0) {
    return;
  }
  order_.resize(candidates_.size());
  std::iota(order_.begin(), order_.end(), size_t{0});
  std::sort(order_.begin(), order_.end(), [&](size_t a, size_t b) {
    return std::pair(candidates_.least[a], a) < std::pair(candidates_.least[b], b);
  });
  const size_t begin = next_.size();
  undominated_.Clear();
  for (const size_t candidate : order_) {
    const int64_t least = candidates_.least[candidate];
    const int16_t* aoi = candidates_.aoi.data() + candidate * sensors_;
    const int dear = candidates_.dear[candidate];
    if (!undominated_.Beat(least, dear, aoi, gaps_.data() + candidate * sensors_)) {
      undominated_.Add(least, dear, aoi);
      next_.Append(candidates_, candidate, sensors_);
    }
  }
  next_.ranges.push_back({cell, begin, next_.size()});
}

void Search::DropLeastPromising() {
  if (next_.size() <= width_) {
    return;
  }
  order_.resize(next_.size());
  std::iota(order_.begin(), order_.end(), size_t{0});
  const auto better = [&](size_t a, size_t b) {
    return std::pair(next_.bound[a], a) < std::pair(next_.bound[b], b);
  };
  const auto end = order_.begin() + static_cast<int64_t>(width_);
  std::nth_element(order_.begin(), end, order_.end(), better);
  result_.least_dropped = std::min(result_.least_dropped, next_.bound[*end]);
  order_.erase(end, order_.end());
  std::sort(order_.begin(), order_.end());
  Labels kept;
  auto next = order_.begin();
  for (const Labels::Range& range : next_.ranges) {
    const size_t begin = kept.size();
    for (; next != order_.end() && *next < range.end; ++next) {
      kept.Append(next_, *next, sensors_);
    }
    if (kept.size() > begin) {
      kept.ranges.push_back({range.cell, begin, kept.size()});
    }
  }
  std::swap(next_, kept);
}

/// Over the stop at slot T: adds the last slot's cost, which the bound holds exactly.
void Search::TakeBestFlight() {
  const auto best = std::min_element(labels_.bound.begin(), labels_.bound.end()) - labels_.bound.begin();
  size_t label = static_cast<size_t>(best);
  result_.cost = labels_.cost[label];
  for (size_t n = 0; n < sensors_; ++n) {
    result_.cost += int64_t{problem_.weights()[n]} * labels_.aoi[label * sensors_ + n];
  }
  for (size_t slot = history_.size() - 1; slot > 0; --slot) {
    const Trail& trail = history_[slot][label];
    result_.actions.push_back({trail.move, trail.schedule});
    label = trail.parent;
  }
  std::reverse(result_.actions.begin(), result_.actions.end());
}

}  // namespace

LabelSearchResult SearchLabels(const PlannerProblem& problem, const LowerBound& lower_bound, int64_t limit,
                               int64_t width, const KeepGoing& keep_going) {
  return Search(problem, lower_bound, limit, width).Run(keep_going);
}

int64_t BytesPerLabel(const PlannerProblem& problem) {
  const int64_t label_bytes = 2 * sizeof(int64_t) + sizeof(int32_t) + sizeof(Trail) +
                              problem.size() * static_cast<int64_t>(sizeof(int16_t));
  constexpr int64_t kCopies = 10;  // this slot's, the next one's before it is cut, growing vectors
  return kCopies * label_bytes + problem.slots() * static_cast<int64_t>(sizeof(Trail));
}

}  // namespace fresco
