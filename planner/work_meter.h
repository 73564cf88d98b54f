// Asks the planner's caller now and then whether to go on: by the work done since, not by a clock, so that
// the planner stays a pure function and a time limit is kept in every part of it. One thread.
#pragma once

#include <cstdint>
#include <functional>
#include <utility>

namespace fresco {

/// How far a pass of the label search is; all zero before the first one.
struct SearchProgress {
  int64_t width = 0;        ///< labels a slot in the present pass
  int slot = 0;             ///< of the present pass
  int64_t labels = 0;       ///< in that slot
  int64_t least_bound = 0;  ///< no flight below the limit costs less: the least bound of any label
};

class WorkMeter {
 public:
  /// Units of work from one question to the next: some 0.05 s.
  static constexpr int64_t kUnitsPerQuestion = int64_t{1} << 25;

  /// `keep_going` is never asked again once it has said no.
  explicit WorkMeter(std::function<bool(const SearchProgress&)> keep_going)
      : keep_going_(std::move(keep_going)) {}

  /// Counts work, a unit being about one simple operation. Returns whether to go on.
  bool Count(int64_t units) {
    units_ += units;
    return units_ < kUnitsPerQuestion ? !stopped_ : Ask();
  }
  /// Asks now, whatever has been counted.
  bool Ask() {
    units_ = 0;
    stopped_ = stopped_ || !keep_going_(progress);
    return !stopped_;
  }
  bool stopped() const { return stopped_; }

  SearchProgress progress;  ///< shown at the next question

 private:
  std::function<bool(const SearchProgress&)> keep_going_;
  int64_t units_ = 0;
  bool stopped_ = false;
};

}  // namespace fresco
