// Groups the results of a study as the figures show them: for each x and policy, over all deployments. Pure
// functions; any thread may call them.
#pragma once

#include <optional>
#include <vector>

#include "report/curve_style.h"
#include "report/paper_study.h"
#include "report/statistics.h"

namespace fresco {

/// A policy that the figures compare.
struct Policy {
  const char* name;    ///< in texts
  const char* column;  ///< first part of its columns' names in CSV files
  CurveRole role;
  std::optional<double> (*average_aoi)(const StudyResult&);  ///< returns its average AoI; none if not known
};
/// All policies, in the order of the curves and columns.
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
  std::vector<StudyResult> results;  ///< one for each deployment

  /// The mean of a policy's average AoI over all results. None if it is not known for one of them, since
  /// means over different deployments can't be compared.
  std::optional<MeanEstimate> Average(const Policy& policy) const;
  /// The gaps in percent of the runs whose optimum is proved. Other runs have no gap.
  std::vector<double> Gaps() const;
  /// The mean and the largest of these gaps; none if there are none.
  std::optional<MeanEstimate> Gap() const;
  std::optional<double> LargestGap() const;
};

/// Returns the groups of a figure, sorted by x.
std::vector<Group> GroupsOf(const PaperStudy& study, const std::vector<StudyResult>& results, Figure figure);

}  // namespace fresco
