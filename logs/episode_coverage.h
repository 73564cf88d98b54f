// Finds out which episodes of a run are complete in a log, and how many transitions of the others are
// missing. Its memory is bounded, whatever the number of episodes. No I/O. Only one thread may use an object.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>

#include "logs/interval_set.h"

namespace fresco {

class EpisodeCoverage {
 public:
  /// If more than `maximum_partial` episodes are incomplete, those of the lowest orders stay incomplete for
  /// good.
  explicit EpisodeCoverage(size_t maximum_partial = 65'536) : maximum_partial_(maximum_partial) {}

  /// Adds the transitions first .. first + count - 1 of an order's episode. `ends_episode` says whether the
  /// last of them is terminal.
  void Add(int64_t order_index, int64_t first, int64_t count, bool ends_episode);

  /// The number of complete and of incomplete episodes.
  int64_t whole() const { return whole_; }
  int64_t partial() const { return given_up_ + static_cast<int64_t>(partial_.size()); }
  /// The number of different transitions, and how many were added again.
  int64_t transitions() const { return transitions_; }
  int64_t repeated_transitions() const { return repeated_; }
  /// The number of transitions of incomplete episodes that are missing. If an episode's end is missing, only
  /// those before its last known transition are counted.
  int64_t missing_transitions() const;

 private:
  struct Partial {
    IntervalSet seen{64};
    int64_t length = 0;  // 0 until the end of the episode was added
  };
  static int64_t Missing(const Partial& partial);
  void GiveUpTheLowest();

  size_t maximum_partial_;
  std::map<int64_t, Partial> partial_;  // by order index
  IntervalSet done_;                    // orders whose episode is complete or given up
  int64_t whole_ = 0;
  int64_t given_up_ = 0;
  int64_t given_up_missing_ = 0;
  int64_t transitions_ = 0;
  int64_t repeated_ = 0;
};

}  // namespace fresco
