// Asks the planner's caller from time to time whether to continue. It counts the work done instead of reading
// a clock, so the planner stays deterministic, and every part of it can be stopped in time. Only one thread
// may use an object.
#pragma once

#include <cstdint>
#include <functional>
#include <utility>

namespace fresco {

/// How far a pass of the label search is; all zero before the first pass.
struct SearchProgress {
  int64_t width = 0;        ///< the most labels a slot in the present pass
  int slot = 0;             ///< that the present pass has reached
  int64_t labels = 0;       ///< labels in that slot
  int64_t least_bound = 0;  ///< least bound of any label: no flight that costs less than the limit costs less
                            ///< than this
};

class WorkMeter {
 public:
  /// Units of work between two questions; they take about 0.05 s.
  static constexpr int64_t kUnitsPerQuestion = int64_t{1} << 25;

  /// Once `keep_going` has returned false, it is not called again.
  explicit WorkMeter(std::function<bool(const SearchProgress&)> keep_going)
      : keep_going_(std::move(keep_going)) {}

  /// Counts work; a unit is about one simple operation. Returns whether to continue.
  bool Count(int64_t units) {
    units_ += units;
    return units_ < kUnitsPerQuestion ? !stopped_ : Ask();
  }
  /// Asks at once, however little work has been counted. Returns whether to continue.
  bool Ask() {
    units_ = 0;
    stopped_ = stopped_ || !keep_going_(progress);
    return !stopped_;
  }
  bool stopped() const { return stopped_; }

  SearchProgress progress;  ///< what the next question passes to keep_going

 private:
  std::function<bool(const SearchProgress&)> keep_going_;
  int64_t units_ = 0;
  bool stopped_ = false;
};

}  // namespace fresco
