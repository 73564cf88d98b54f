#include "logs/episode_coverage.h"

#include <algorithm>

namespace fresco {

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
