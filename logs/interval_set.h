// A set of numbers that mostly follow one another, as intervals: which of a sequence are there, and which
// are missing. Its memory is bounded. Pure.
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
  /// Beyond so many intervals the two lowest are joined: what is missing between them counts as missing for
  /// good, and is no more taken as new.
  explicit IntervalSet(size_t maximum_intervals = 65'536) : maximum_intervals_(maximum_intervals) {}

  /// Adds first .. last, both in -2^62 .. 2^62; returns how many of these numbers were new.
  int64_t Add(int64_t first, int64_t last);
  bool Contains(int64_t number) const;

  /// Distinct numbers that were added.
  int64_t count() const { return count_; }
  bool empty() const { return intervals_.empty(); }
  int64_t first() const { return intervals_.begin()->first; }
  int64_t last() const { return intervals_.rbegin()->second; }
  /// Numbers between first and last that were not added.
  int64_t missing() const { return empty() ? 0 : last() - first() + 1 - count_; }
  /// The lowest gaps, as far as they are still known.
  std::vector<Interval> Gaps(size_t maximum) const;

 private:
  void JoinTheLowest();

  size_t maximum_intervals_;
  std::map<int64_t, int64_t> intervals_;  // first to last; neither overlap nor touch
  int64_t count_ = 0;
};

}  // namespace fresco
