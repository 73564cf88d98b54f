// A set of mostly consecutive numbers, stored as intervals. It tells which numbers of a sequence are missing.
// Its memory is bounded. Only one thread at a time may use an object.
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

}  // namespace fresco
