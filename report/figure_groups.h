// The results of a study as the figures show them: by x, over deployments, for each policy. Pure.
#pragma once

#include <optional>
#include <vector>

#include "report/curve_style.h"
#include "report/paper_study.h"
#include "report/statistics.h"

namespace fresco {

/// What the figures compare, in the order of their curves and columns.
struct Policy {
  const char* name;
  const char* column;
  CurveRole role;
  std::optional<double> (*average_aoi)(const StudyResult&);  ///< none: not known
};
inline constexpr Policy kPolicies[] = {
    {"DQN", "dqn", CurveRole::kDqn,
     [](const StudyResult& result) { return std::optional(result.average_aoi); }},
    {"AoI-based", "aoi", CurveRole::kAoiBased,
     [](const StudyResult& result) { return std::optional(result.aoi_average_aoi); }},
    {"distance-based", "distance", CurveRole::kDistanceBased,
     [](const StudyResult& result) { return std::optional(result.distance_average_aoi); }},
    {"exact optimum", "optimal", CurveRole::kOptimum,
     [](const StudyResult& result) { return result.optimal_average_aoi; }},
};

/// The results at one x of a figure.
struct Group {
  double x = 0;
  std::vector<StudyResult> results;

  /// Over all results; none if it is not known of one of them: a mean over some deployments is not to be
  /// held against another policy's over all.
  std::optional<MeanEstimate> Average(const Policy& policy) const;
  /// The gaps of the runs whose optimum is proved; no other run has a gap.
  std::vector<double> Gaps() const;
  std::optional<MeanEstimate> Gap() const;
  std::optional<double> LargestGap() const;
};

/// The groups of a figure, by x.
std::vector<Group> GroupsOf(const PaperStudy& study, const std::vector<StudyResult>& results, Figure figure);

}  // namespace fresco
