#include "logs/coverage.h"

#include <algorithm>
#include <iterator>

namespace fresco {

bool IntervalSet::Contains(int64_t number) const {
  const auto behind = intervals_.upper_bound(number);
  return behind != intervals_.begin() && std::prev(behind)->second >= number;
}

int64_t IntervalSet::Add(int64_t first, int64_t last) {
  int64_t known = 0;
  Interval joined = {first, last};
  auto next = intervals_.upper_bound(first);
  if (next != intervals_.begin() && std::prev(next)->second >= first - 1) {
    --next;
  }
  while (next != intervals_.end() && next->first <= last + 1) {
    known += std::max<int64_t>(0, std::min(last, next->second) - std::max(first, next->first) + 1);
    joined = {std::min(joined.first, next->first), std::max(joined.last, next->second)};
    next = intervals_.erase(next);
  }
  intervals_.emplace_hint(next, joined.first, joined.last);
  if (intervals_.size() > maximum_intervals_) {
    JoinTheLowest();
  }
  const int64_t added = last - first + 1 - known;
  count_ += added;
  return added;
}

std::vector<Interval> IntervalSet::Gaps(size_t maximum) const {
  std::vector<Interval> gaps;
  for (auto next = intervals_.begin(); next != intervals_.end() && gaps.size() < maximum; ++next) {
    if (next != intervals_.begin()) {
      gaps.push_back({std::prev(next)->second + 1, next->first - 1});
    }
  }
  return gaps;
}

void IntervalSet::JoinTheLowest() {
  const auto second = std::next(intervals_.begin());
  intervals_.begin()->second = second->second;
  intervals_.erase(second);
}

void EpisodeCoverage::Add(int64_t order_index, int64_t first, int64_t count, bool ends_episode) {
  if (done_.Contains(order_index)) {
    repeated_ += count;
    return;
  }
  Partial& episode = partial_[order_index];
  const int64_t added = episode.seen.Add(first, first + count - 1);
  transitions_ += added;
  repeated_ += count - added;
  if (ends_episode) {
    episode.length = first + count;
  }
  if (episode.length > 0 && Missing(episode) == 0) {
    ++whole_;
    done_.Add(order_index, order_index);
    partial_.erase(order_index);
  } else if (partial_.size() > maximum_partial_) {
    GiveUpTheLowest();
  }
}

int64_t EpisodeCoverage::Missing(const Partial& partial) {
  const int64_t length = std::max(partial.length, partial.seen.last() + 1);
  return length - partial.seen.count();
}

int64_t EpisodeCoverage::missing_transitions() const {
  int64_t missing = given_up_missing_;
  for (const auto& [order, partial] : partial_) {
    missing += Missing(partial);
  }
  return missing;
}

void EpisodeCoverage::GiveUpTheLowest() {
  const auto lowest = partial_.begin();
  ++given_up_;
  given_up_missing_ += Missing(lowest->second);
  done_.Add(lowest->first, lowest->first);
  partial_.erase(lowest);
}

}  // namespace fresco
