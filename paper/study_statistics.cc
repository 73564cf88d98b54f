#include "paper/study_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "core/error.h"

namespace fresco {
namespace {

constexpr char kNotKnown[] = "-";

std::string WithSpread(const std::optional<MeanEstimate>& estimate) {
  if (!estimate) {
    return kNotKnown;
  }
  return fmt::format("{:.2f}", estimate->mean) +
         (estimate->half_width ? fmt::format(" ± {:.2f}", *estimate->half_width) : "");
}

/// Adds the cells of the mean and of half its interval.
void AddCells(const std::optional<MeanEstimate>& estimate, std::vector<CsvCell>& row) {
  row.push_back(estimate ? CsvCell(estimate->mean) : CsvCell(std::string()));
  row.push_back(CellOrEmpty(estimate ? estimate->half_width : std::nullopt));
}

}  // namespace

std::optional<MeanEstimate> Group::Average(const Policy& policy) const {
  std::vector<double> sample;
  for (const StudyResult& result : results) {
    const std::optional<PolicyResult> reached = policy.result(result);
    if (!reached) {
      return std::nullopt;
    }
    sample.push_back(reached->average_aoi);
  }
  return EstimateMean(sample);
}

std::vector<double> Group::Gaps() const {
  std::vector<double> gaps;
  for (const StudyResult& result : results) {
    if (result.gap_percent) {
      gaps.push_back(*result.gap_percent);
    }
  }
  return gaps;
}

std::optional<MeanEstimate> Group::Gap() const {
  const std::vector<double> gaps = Gaps();
  return gaps.empty() ? std::nullopt : std::optional(EstimateMean(gaps));
}

std::optional<double> Group::LargestGap() const {
  const std::vector<double> gaps = Gaps();
  return gaps.empty() ? std::nullopt : std::optional(*std::max_element(gaps.begin(), gaps.end()));
}

std::vector<Group> GroupsOf(const PaperStudy& study, const std::vector<StudyResult>& results, Figure figure) {
  std::map<double, Group> groups;
  for (const StudyPoint& point : study.points) {
    if (point.figure == figure) {
      groups[point.x].x = point.x;
      groups[point.x].results.push_back(results[point.job]);
    }
  }
  std::vector<Group> sorted;
  for (auto& [x, group] : groups) {
    sorted.push_back(std::move(group));
  }
  return sorted;
}

void WriteGroups(const std::filesystem::path& path, const std::string& x_column,
                 const std::vector<Group>& groups) {
  std::vector<std::string> header = {x_column, "deployments"};
  for (const Policy& policy : kPolicies) {
    header.push_back(fmt::format("{}_average_aoi", policy.column));
    header.push_back(fmt::format("{}_half_width", policy.column));
  }
  header.insert(header.end(), {"gap_percent", "gap_half_width", "gap_largest_percent"});
  std::vector<std::vector<CsvCell>> rows;
  for (const Group& group : groups) {
    std::vector<CsvCell> row = {static_cast<int64_t>(group.x), static_cast<int64_t>(group.results.size())};
    for (const Policy& policy : kPolicies) {
      AddCells(group.Average(policy), row);
    }
    AddCells(group.Gap(), row);
    row.push_back(CellOrEmpty(group.LargestGap()));
    rows.push_back(std::move(row));
  }
  WriteCsv(path, header, rows);
}

ReportTable GroupTable(const std::string& title, const std::string& x_label,
                       const std::vector<Group>& groups) {
  ReportTable table{title, {x_label}, {}};
  for (const Policy& policy : kPolicies) {
    table.header.push_back(policy.name);
  }
  table.header.insert(table.header.end(), {"DQN's gap (%)", "largest gap (%)"});
  for (const Group& group : groups) {
    std::vector<std::string> row = {fmt::format("{:g}", group.x)};
    for (const Policy& policy : kPolicies) {
      row.push_back(WithSpread(group.Average(policy)));
    }
    const std::optional<double> largest = group.LargestGap();
    const size_t gaps = group.Gaps().size();
    const std::string some =
        gaps < group.results.size() ? fmt::format(" ({} of {} runs)", gaps, group.results.size()) : "";
    row.insert(row.end(),
               {WithSpread(group.Gap()) + some, largest ? fmt::format("{:.2f}", *largest) : kNotKnown});
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace fresco
