// Plots the greedy flights of a run's network versions during the training. Pure functions; any thread may
// call them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "report/line_plot.h"

namespace fresco {

/// The result of the greedy flight of one version.
struct LearningPoint {
  int64_t updates = 0;     ///< updates made when the version was made
  double average_aoi = 0;  ///< in slots
  bool arrived = false;
};

struct LearningCurve {
  std::string title;
  std::vector<LearningPoint> points{};          ///< at least one, sorted by updates
  std::optional<double> optimum_average_aoi{};  ///< of the same scenario, in slots, > 0; none if not proved
};

/// The plot shows flights that arrived as dots, the best of them so far as a line, flights that did not
/// arrive as marks at the top, and the optimum as a horizontal line, with the gap to it on the right axis.
LinePlot LearningCurvePlot(const LearningCurve& curve);

}  // namespace fresco
