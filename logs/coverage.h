// Finds out what of a sequence is missing: numbers of messages, transitions of episodes. The memory is
// bounded, whatever is added. No I/O. Only one thread at a time may use an object.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace fresco {

struct Interval {
  int64_t first = 0;
  int64_t last = 0;  ///< included
  bool operator==(const Interval&) const = default;
};

/// A set of mostly consecutive numbers, stored as intervals.
class IntervalSet {
 public:
  /// If there are more than `maximum_intervals`, the two lowest are joined. The numbers between them then
  /// stay missing for good: Add does not count them as new any more.
  explicit IntervalSet(size_t maximum_intervals = 65'536) : maximum_intervals_(maximum_intervals) {}

  /// Adds first .. last, both in -2^62 .. 2^62. Returns how many of these numbers are new.
  int64_t Add(int64_t first, int64_t last);
  bool Contains(int64_t number) const;

  /// The number of different numbers that were added.
  int64_t count() const { return count_; }
  bool empty() const { return intervals_.empty(); }
  /// The smallest and the largest number. The set must not be empty.
  int64_t first() const { return intervals_.begin()->first; }
  int64_t last() const { return intervals_.rbegin()->second; }
  /// How many numbers between first and last were not added.
  int64_t missing() const { return empty() ? 0 : last() - first() + 1 - count_; }
  /// Returns the lowest gaps, at most `maximum`. Gaps between joined intervals are not known any more.
  std::vector<Interval> Gaps(size_t maximum) const;

 private:
  void JoinTheLowest();

  size_t maximum_intervals_;
  std::map<int64_t, int64_t> intervals_;  // from first to last; intervals neither overlap nor touch
  int64_t count_ = 0;
};

/// Which episodes of a run are complete, and how many transitions of the others are missing.
class EpisodeCoverage {
 public:
  /// If more than `maximum_partial` episodes are incomplete, those of the lowest orders stay incomplete for
  /// good.
  explicit EpisodeCoverage(size_t maximum_partial = 65'536) : maximum_partial_(maximum_partial) {}

  /// Adds the transitions first .. first + count - 1 of an order's episode. (If states are too long for one
  /// message, LogSummary counts the parts of transitions instead.) `ends_episode` says whether the
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
