#include "planner/label_search.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "planner/labels.h"

namespace fresco {
namespace {

// Returns the opposite move, which leads to the cell from which `move` leads here.
Move Opposite(Move move) {
  constexpr std::array kOpposite = {Move::kSouth, Move::kNorth, Move::kWest, Move::kEast, Move::kHover};
  return kOpposite[static_cast<size_t>(move)];
}

/// Returns the indices of the `width` labels with the least bounds, ascending. Lowers `least_dropped` to the
/// least bound of the other labels.
std::vector<size_t> MostPromising(const std::vector<int64_t>& bound, size_t width, int64_t* least_dropped) {
  std::vector<size_t> order(bound.size());
  std::iota(order.begin(), order.end(), size_t{0});
  const auto end = order.begin() + static_cast<int64_t>(width);
  std::nth_element(order.begin(), end, order.end(),
                   [&](size_t a, size_t b) { return std::pair(bound[a], a) < std::pair(bound[b], b); });
  *least_dropped = std::min(*least_dropped, bound[*end]);
  order.erase(end, order.end());
  std::sort(order.begin(), order.end());
  return order;
}

class Search {
 public:
  Search(const PlannerProblem& problem, const LowerBound& lower_bound, const CoverageDistances& distances,
         int64_t limit, int64_t width, WorkMeter& meter)
      : problem_(problem),
        lower_bound_(lower_bound),
        distances_(distances),
        limit_(limit),
        width_(static_cast<size_t>(width)),
        meter_(meter),
        sensors_(static_cast<size_t>(problem.size())),
        range_of_cell_(static_cast<size_t>(problem.cells()), -1),
        child_aoi_(sensors_),
        undominated_(sensors_, problem.energy_binds()) {}

  LabelSearchResult Run();

 private:
  void Begin();
  bool AdvanceFrom(int slot);
  void FindRanges();
  std::vector<int32_t> NextCells() const;
  void Generate(int slot, int32_t cell);
  void Branch(size_t parent, int dear, int32_t from, Move move, const Dominance& dominance,
              LowerBound::OverCell& bound);
  void AddChild(size_t parent, int64_t cost, int dear, int schedule, Move move, const Dominance& dominance,
                LowerBound::OverCell& bound);
  bool AppendGaps(int64_t cost, const Dominance& dominance, const LowerBound::OverCell& bound);
  void CutCandidates();
  void KeepUndominated(int32_t cell);
  void CutNext();
  int64_t LeastBound() const { return *std::min_element(labels_.bound.begin(), labels_.bound.end()); }
  void RecordBestFlight();

  const PlannerProblem& problem_;
  const LowerBound& lower_bound_;
  const CoverageDistances& distances_;
  int64_t limit_;
  size_t width_;
  WorkMeter& meter_;
  size_t sensors_;
  Labels labels_;             // labels of the present slot
  Labels next_;               // labels of the next slot
  int64_t cutoff_ = kNoCost;  // a label of the next slot with this bound or more would be dropped for lack of
                              // room
  Labels candidates_;         // labels of the next slot over one cell, before dominance
  std::vector<double> gaps_;  // gaps of the candidates, see Undominated::Beat
  std::vector<int32_t> range_of_cell_;
  std::vector<int16_t> child_aoi_;
  Undominated undominated_;
  std::vector<std::vector<Trail>> history_;  // by slot - 1
  LabelSearchResult result_;
};

LabelSearchResult Search::Run() {
  Begin();
  for (int slot = 1; slot < problem_.slots(); ++slot) {
    const int64_t least_bound = LeastBound();
    meter_.progress = {static_cast<int64_t>(width_), slot, static_cast<int64_t>(labels_.size()),
                       std::min(least_bound, result_.least_dropped)};
    if (!meter_.Ask() || !AdvanceFrom(slot)) {
      result_.least_dropped = std::min(result_.least_dropped, least_bound);
      return std::move(result_);
    }
    result_.labels += static_cast<int64_t>(labels_.size());
    if (labels_.size() == 0) {
      return std::move(result_);
    }
  }
  RecordBestFlight();
  return std::move(result_);
}

void Search::Begin() {
  labels_.cost = {0};
  labels_.dear = {0};
  labels_.least = {0};
  labels_.aoi.assign(sensors_, 1);
  labels_.bound = {lower_bound_.OfAnyFlight()};
  labels_.trails = {Trail{}};
  labels_.ranges = {{problem_.start(), 0, 1}};
  history_ = {labels_.trails};
}

/// Replaces the labels of a slot by those of the next one. Returns false if the meter has stopped.
bool Search::AdvanceFrom(int slot) {
  next_.Clear();
  cutoff_ = kNoCost;
  FindRanges();
  for (const int32_t cell : NextCells()) {
    Generate(slot, cell);
    KeepUndominated(cell);
    if (meter_.stopped()) {
      return false;
    }
    if (next_.size() > 2 * width_) {
      CutNext();
    }
  }
  if (next_.size() > width_) {
    CutNext();
  }
  std::swap(labels_, next_);
  history_.push_back(labels_.trails);
  return true;
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

/// Generates all children over `cell` at the beginning of slot + 1 from the labels over it and its
/// neighbours.
void Search::Generate(int slot, int32_t cell) {
  candidates_.Clear();
  gaps_.clear();
  const int allowance = problem_.DearAllowance(slot + 1, cell);
  if (allowance < 0) {
    return;
  }
  LowerBound::OverCell bound(lower_bound_, slot + 1, cell);
  const Dominance dominance(problem_, distances_, slot + 1, cell);
  for (const Move move : kAllMoves) {
    const int from = problem_.After(cell, Opposite(move));
    const int32_t range = from < 0 ? -1 : range_of_cell_[static_cast<size_t>(from)];
    if (range < 0) {
      continue;
    }
    const Labels::Range& labels = labels_.ranges[static_cast<size_t>(range)];
    for (size_t parent = labels.begin; parent < labels.end && !meter_.stopped(); ++parent) {
      const int dear = labels_.dear[parent] + (problem_.energy_binds() && problem_.IsDear(move) ? 1 : 0);
      if (dear <= allowance) {
        Branch(parent, dear, from, move, dominance, bound);
      }
    }
  }
}

/// Generates one child for each covered sensor, which transmits; or one child without a transmission if no
/// sensor is covered, since serving a sensor is never worse than serving none.
void Search::Branch(size_t parent, int dear, int32_t from, Move move, const Dominance& dominance,
                    LowerBound::OverCell& bound) {
  const int16_t* aoi = labels_.aoi.data() + parent * sensors_;
  int64_t cost = labels_.cost[parent];
  for (size_t n = 0; n < sensors_; ++n) {
    cost += problem_.weights()[n] * aoi[n];
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
  if (candidates_.size() > 2 * width_) {
    CutCandidates();
  }
}

void Search::AddChild(size_t parent, int64_t cost, int dear, int schedule, Move move,
                      const Dominance& dominance, LowerBound::OverCell& bound) {
  constexpr int64_t kUnitsPerSensor = 16;
  meter_.Count(static_cast<int64_t>(sensors_) * kUnitsPerSensor);
  // A child's bound is at least that of its parent.
  const int64_t least = std::max(labels_.bound[parent], cost + bound(child_aoi_.data(), dear));
  if (least >= limit_ || !AppendGaps(cost, dominance, bound)) {
    return;
  }
  if (least >= cutoff_) {
    result_.least_dropped = std::min(result_.least_dropped, least);
    gaps_.resize(gaps_.size() - sensors_);
    return;
  }
  candidates_.cost.push_back(cost);
  candidates_.bound.push_back(least);
  candidates_.dear.push_back(dear);
  candidates_.least.push_back(dominance.LeastCost(cost, child_aoi_.data()));
  candidates_.aoi.insert(candidates_.aoi.end(), child_aoi_.begin(), child_aoi_.end());
  candidates_.trails.push_back({static_cast<uint32_t>(parent), static_cast<int16_t>(schedule), move});
}

/// Appends the child's gaps. Returns false if some sensor can't be served early enough for a flight below the
/// limit.
bool Search::AppendGaps(int64_t cost, const Dominance& dominance, const LowerBound::OverCell& bound) {
  const size_t begin = gaps_.size();
  gaps_.resize(begin + sensors_);
  for (size_t n = 0; n < sensors_; ++n) {
    const int longest = bound.LongestUnserved(static_cast<int>(n), child_aoi_[n], limit_ - cost);
    const int excess = longest - dominance.shortest_unserved(n);
    if (excess < 0) {
      gaps_.resize(begin);
      return false;
    }
    gaps_[begin + n] = static_cast<double>(problem_.weights()[n]) * excess;
  }
  return true;
}

void Search::CutCandidates() {
  Labels kept;
  std::vector<double> kept_gaps;
  for (const size_t index : MostPromising(candidates_.bound, width_, &result_.least_dropped)) {
    kept.Append(candidates_, index, sensors_);
    const double* gaps = gaps_.data() + index * sensors_;
    kept_gaps.insert(kept_gaps.end(), gaps, gaps + sensors_);
  }
  std::swap(candidates_, kept);
  std::swap(gaps_, kept_gaps);
}

void Search::KeepUndominated(int32_t cell) {
  std::vector<size_t> order(candidates_.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return std::pair(candidates_.least[a], a) < std::pair(candidates_.least[b], b);
  });
  const size_t begin = next_.size();
  undominated_.Clear();
  for (const size_t candidate : order) {
    if (!meter_.Count(static_cast<int64_t>(undominated_.size() * sensors_))) {
      return;
    }
    const int64_t least = candidates_.least[candidate];
    const int16_t* aoi = candidates_.aoi.data() + candidate * sensors_;
    const int dear = candidates_.dear[candidate];
    if (!undominated_.Beat(least, dear, aoi, gaps_.data() + candidate * sensors_)) {
      undominated_.Add(least, dear, aoi);
      next_.Append(candidates_, candidate, sensors_);
    }
  }
  if (next_.size() > begin) {
    next_.ranges.push_back({cell, begin, next_.size()});
  }
}

void Search::CutNext() {
  const std::vector<size_t> order = MostPromising(next_.bound, width_, &result_.least_dropped);
  Labels kept;
  auto next = order.begin();
  for (const Labels::Range& range : next_.ranges) {
    const size_t begin = kept.size();
    for (; next != order.end() && *next < range.end; ++next) {
      kept.Append(next_, *next, sensors_);
    }
    if (kept.size() > begin) {
      kept.ranges.push_back({range.cell, begin, kept.size()});
    }
  }
  cutoff_ = *std::max_element(kept.bound.begin(), kept.bound.end());
  std::swap(next_, kept);
}

/// Writes the flight of the cheapest label over the stop at slot T to result_, if its cost, the last slot's
/// included, is below the limit.
void Search::RecordBestFlight() {
  int64_t least = limit_;
  size_t label = 0;
  for (size_t i = 0; i < labels_.size(); ++i) {
    int64_t cost = labels_.cost[i];
    for (size_t n = 0; n < sensors_; ++n) {
      cost += problem_.weights()[n] * labels_.aoi[i * sensors_ + n];
    }
    if (cost < least) {
      least = cost;
      label = i;
    }
  }
  if (least == limit_) {
    return;
  }
  result_.cost = least;
  for (size_t slot = history_.size() - 1; slot > 0; --slot) {
    const Trail& trail = history_[slot][label];
    result_.actions.push_back({trail.move, trail.schedule});
    label = trail.parent;
  }
  std::reverse(result_.actions.begin(), result_.actions.end());
}

}  // namespace

LabelSearchResult SearchLabels(const PlannerProblem& problem, const LowerBound& lower_bound,
                               const CoverageDistances& distances, int64_t limit, int64_t width,
                               WorkMeter& meter) {
  return Search(problem, lower_bound, distances, limit, width, meter).Run();
}

int64_t BytesPerLabel(const PlannerProblem& problem) {
  // Counts this slot's labels, the next slot's before the drop, one cell's candidates, and spare room of
  // vectors.
  constexpr int64_t kCopies = 12;
  return kCopies * Labels::Bytes(problem.size()) + problem.slots() * static_cast<int64_t>(sizeof(Trail));
}

}  // namespace fresco
