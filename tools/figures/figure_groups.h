// The results of a study as the figures show them: by x, over deployments, for each policy. Pure.
#pragma once

#include <functional>
#include <vector>

#include "tools/figures/paper_study.h"
#include "tools/plots/curve_style.h"
#include "tools/statistics.h"

namespace fresco {

/// What the figures compare, in the order of their curves and columns.
struct Policy {
  const char* name;
  const char* column;
  CurveRole role;
  double StudyResult::*average_aoi;
};
inline constexpr Policy kPolicies[] = {
    {"DQN", "dqn", CurveRole::kDqn, &StudyResult::average_aoi},
    {"AoI-based", "aoi", CurveRole::kAoiBased, &StudyResult::aoi_average_aoi},
    {"distance-based", "distance", CurveRole::kDistanceBased, &StudyResult::distance_average_aoi},
    {"exact optimum", "optimal", CurveRole::kOptimum, &StudyResult::lower_bound_average_aoi},
};

/// The results at one x of a figure.
struct Group {
  double x = 0;
  std::vector<StudyResult> results;

  MeanEstimate Estimate(const std::function<double(const StudyResult&)>& figure) const;
  MeanEstimate Average(const Policy& policy) const {
    return Estimate([&](const StudyResult& result) { return result.*policy.average_aoi; });
  }
  MeanEstimate Gap() const {
    return Estimate([](const StudyResult& result) { return result.gap_percent; });
  }
  double LargestGap() const;
};

/// The groups of a figure, by x.
std::vector<Group> GroupsOf(const PaperStudy& study, const std::vector<StudyResult>& results, Figure figure);

}  // namespace fresco
