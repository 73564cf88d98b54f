// Statistics over the results of a study, as the figures show them: for each x and policy, the mean over all
// deployments; and their tables. Any thread may call these functions; only WriteGroups writes a file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/csv.h"
#include "paper/paper_study.h"
#include "report/line_plot.h"
#include "report/mean_estimate.h"
#include "report/report.h"

namespace fresco {

/// A policy that the figures compare.
struct Policy {
  const char* name;    ///< in texts
  const char* column;  ///< first part of its columns' names in CSV files
  CurveRole role;
  std::optional<PolicyResult> (*result)(const StudyResult&);  ///< returns its result; none if not known
};
/// All policies, in the order of the curves and columns.
inline constexpr Policy kPolicies[] = {
    {"DQN", "dqn", CurveRole::kDqn, [](const StudyResult& run) { return std::optional(run.dqn); }},
    {"AoI-based", "aoi", CurveRole::kAoiBased,
     [](const StudyResult& run) { return std::optional(run.aoi_based); }},
    {"distance-based", "distance", CurveRole::kDistanceBased,
     [](const StudyResult& run) { return std::optional(run.distance_based); }},
    {"exact optimum", "optimal", CurveRole::kOptimum, [](const StudyResult& run) { return run.optimal; }},
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

/// Returns the cell of a CSV file for a value; an empty one if it is not known.
template <class Value>
CsvCell CellOrEmpty(const std::optional<Value>& value) {
  return value ? CsvCell(*value) : CsvCell(std::string());
}

/// Writes the groups as a CSV file, a row for each x, whose column is called `x_column`.
void WriteGroups(const std::filesystem::path& path, const std::string& x_column,
                 const std::vector<Group>& groups);

/// Returns the groups as a table for the report.
ReportTable GroupTable(const std::string& title, const std::string& x_label,
                       const std::vector<Group>& groups);

}  // namespace fresco
