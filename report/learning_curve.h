// How good the greedy flights of a run's versions were as training went on. Pure; any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "report/line_plot.h"

namespace fresco {

/// A greedy flight of one version of the network during training.
struct LearningPoint {
  int64_t updates = 0;
  double average_aoi = 0;  ///< in slots
  bool arrived = false;
};

struct LearningCurve {
  std::string title;
  std::vector<LearningPoint> points{};          ///< by updates
  std::optional<double> optimum_average_aoi{};  ///< in slots, of the same scenario; positive
};

/// Flights that arrived as dots, the best of them so far as a line, the optimum across, the gap to it on
/// the right; flights that did not arrive are marks at the top, whatever their AoI. At least one point.
LinePlot LearningCurvePlot(const LearningCurve& curve);

}  // namespace fresco
