// One pass of label setting, slot by slot: it extends partial flights (labels) by one slot at a time. It
// drops a label if the label's lower bound shows that it can't beat the best flight known, or if another
// label beats it (dominance). If more than `width` labels are left in a slot, it drops the least promising
// ones, too; the pass then proves a lower bound instead of an optimum. Deterministic. Part of the exact
// planner; runs on the thread that calls it.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "planner/dominance.h"
#include "planner/lower_bound.h"

namespace fresco {

/// The cost if there is no flight.
inline constexpr int64_t kNoCost = std::numeric_limits<int64_t>::max();

struct LabelSearchResult {
  int64_t cost = kNoCost;           ///< of the best flight below the limit; kNoCost: none was found
  std::vector<Action> actions;      ///< its T - 1 actions; schedule n + 1 is PlannerProblem::sensors()[n], 0:
                                    ///< none
  int64_t least_dropped = kNoCost;  ///< least bound of the labels that were dropped for lack of room or
                                    ///< because the meter stopped; kNoCost: none was
  int64_t labels = 0;               ///< labels kept, over all slots

  /// No flight costs less than this; `limit` is that of the search.
  int64_t LowerBound(int64_t limit) const { return std::min({cost, least_dropped, limit}); }
};

/// Searches for a flight that costs less than `limit` until it is done or the meter stops. Keeps at most
/// `width` (>= 1) labels a slot.
LabelSearchResult SearchLabels(const PlannerProblem& problem, const LowerBound& lower_bound,
                               const CoverageDistances& distances, int64_t limit, int64_t width,
                               WorkMeter& meter);

/// The most bytes that a pass takes for each label of its width.
int64_t BytesPerLabel(const PlannerProblem& problem);

}  // namespace fresco
