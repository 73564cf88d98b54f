// Which episodes of a run stand in a log as a whole, and what is missing of the others. Its memory does not
// depend on the number of episodes. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>

#include "logs/interval_set.h"

namespace fresco {

class EpisodeCoverage {
 public:
  /// Beyond so many episodes that are not whole, those of the lowest orders count as partial for good.
  explicit EpisodeCoverage(size_t maximum_partial = 65'536) : maximum_partial_(maximum_partial) {}

  /// Transitions first .. first + count - 1 of an order's episode; `ends_episode`: the last one is terminal.
  void Add(int64_t order_index, int64_t first, int64_t count, bool ends_episode);

  int64_t whole() const { return whole_; }
  int64_t partial() const { return given_up_ + static_cast<int64_t>(partial_.size()); }
  /// Distinct ones, and how many came again.
  int64_t transitions() const { return transitions_; }
  int64_t repeated_transitions() const { return repeated_; }
  /// Of partial episodes, up to the last transition that is there: the least that is missing.
  int64_t missing_transitions() const;

 private:
  struct Partial {
    IntervalSet seen{64};
    int64_t length = 0;  // 0: the end has not been seen
  };
  static int64_t Missing(const Partial& partial);
  void GiveUpTheLowest();

  size_t maximum_partial_;
  std::map<int64_t, Partial> partial_;  // by order
  IntervalSet done_;                    // whole, or given up
  int64_t whole_ = 0;
  int64_t given_up_ = 0;
  int64_t given_up_missing_ = 0;
  int64_t transitions_ = 0;
  int64_t repeated_ = 0;
};

}  // namespace fresco
