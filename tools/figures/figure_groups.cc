#include "tools/figures/figure_groups.h"

#include <algorithm>
#include <iterator>
#include <map>

namespace fresco {

MeanEstimate Group::Estimate(const std::function<double(const StudyResult&)>& figure) const {
  std::vector<double> sample;
  std::transform(results.begin(), results.end(), std::back_inserter(sample), figure);
  return EstimateMean(sample);
}

double Group::LargestGap() const {
  double largest = results.front().gap_percent;
  for (const StudyResult& result : results) {
    largest = std::max(largest, result.gap_percent);
  }
  return largest;
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
