// One pass of label setting, slot by slot: a label is a way to be over a cell at the beginning of a
// slot, with the AoI and the cost that it brought. Labels that can't beat the best flight known are
// dropped by their lower bound, labels that another one beats by dominance; beyond `width` labels a
// slot the least promising ones are dropped too, and then the pass proves a bound instead of an
// optimum. Deterministic; used by one thread.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "uav/lower_bound.h"

namespace fresco {

inline constexpr int64_t kNoCost = std::numeric_limits<int64_t>::max();

struct LabelSearchResult {
  int64_t cost = kNoCost;           ///< of the best flight found below the limit given; kNoCost: none
  std::vector<Action> actions;      ///< its T - 1 actions, schedules as PlannerProblem::sensors() + 1
  int64_t least_dropped = kNoCost;  ///< least bound of a label dropped for want of room
  int64_t labels = 0;               ///< labels kept, over all slots
  bool stopped = false;             ///< by keep_going; then `cost` is kNoCost

  /// No flight costs less.
  int64_t LowerBound(int64_t limit) const { return std::min({cost, least_dropped, limit}); }
};

/// What a pass asks after every slot: slots done, labels kept in it and the least bound among them.
using KeepGoing = std::function<bool(int slot, int64_t labels, int64_t least_bound)>;

/// Searches for flights cheaper than `limit`.
LabelSearchResult SearchLabels(const PlannerProblem& problem, const LowerBound& lower_bound, int64_t limit,
                               int64_t width, const KeepGoing& keep_going);

/// Bytes that a pass takes for each label of its width, at most.
int64_t BytesPerLabel(const PlannerProblem& problem);

}  // namespace fresco
