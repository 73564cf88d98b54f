// One pass of label setting, slot by slot. Labels that can't beat the best flight known are dropped by
// their lower bound, labels that another one beats by dominance; beyond `width` labels a slot the least
// promising ones are dropped too, and then the pass proves a bound instead of an optimum.
// Deterministic; used by one thread. A part of the exact planner.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "planner/dominance.h"
#include "planner/lower_bound.h"

namespace fresco {

inline constexpr int64_t kNoCost = std::numeric_limits<int64_t>::max();

struct LabelSearchResult {
  int64_t cost = kNoCost;           ///< of the best flight found below the limit given; kNoCost: none
  std::vector<Action> actions;      ///< its T - 1 actions, schedules as PlannerProblem::sensors() + 1
  int64_t least_dropped = kNoCost;  ///< least bound of a label not followed to the end for other reasons
                                    ///< than the limit and dominance: want of room, or a stop
  int64_t labels = 0;               ///< labels kept, over all slots

  /// No flight costs less.
  int64_t LowerBound(int64_t limit) const { return std::min({cost, least_dropped, limit}); }
};

/// Searches for flights cheaper than `limit`, until done or the meter stops.
LabelSearchResult SearchLabels(const PlannerProblem& problem, const LowerBound& lower_bound,
                               const CoverageDistances& distances, int64_t limit, int64_t width,
                               WorkMeter& meter);

/// Bytes that a pass takes for each label of its width, at most.
int64_t BytesPerLabel(const PlannerProblem& problem);

}  // namespace fresco
