#include "report/figure_groups.h"

#include <algorithm>
#include <map>

namespace fresco {

std::optional<MeanEstimate> Group::Average(const Policy& policy) const {
  std::vector<double> sample;
  for (const StudyResult& result : results) {
    const std::optional<double> average_aoi = policy.average_aoi(result);
    if (!average_aoi) {
      return std::nullopt;
    }
    sample.push_back(*average_aoi);
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

}  // namespace fresco
