#include "report/learning_curve.h"

#include <cmath>

#include "core/error.h"

namespace fresco {

LinePlot LearningCurvePlot(const LearningCurve& curve) {
  FRESCO_CHECK(!curve.points.empty());
  constexpr int64_t kManyUpdates = 10'000;
  const bool thousands = curve.points.back().updates >= kManyUpdates;
  Curve flights{.name = "greedy flight", .role = CurveRole::kDqn, .shape = CurveShape::kFaintDots};
  Curve best{.name = "best so far", .role = CurveRole::kDqn, .shape = CurveShape::kSteps};
  Curve failures{.name = "did not arrive", .role = CurveRole::kAoiBased, .shape = CurveShape::kTopMarks};
  for (const LearningPoint& point : curve.points) {
    const double x = static_cast<double>(point.updates) / (thousands ? 1000 : 1);
    flights.x.push_back(x);
    flights.y.push_back(point.arrived ? point.average_aoi : std::nan(""));
    if (!point.arrived) {
      failures.x.push_back(x);
    }
    const bool last = &point == &curve.points.back();
    const bool better = point.arrived && (best.y.empty() || point.average_aoi < best.y.back());
    if (better || (last && !best.y.empty())) {
      best.x.push_back(x);
      best.y.push_back(better ? point.average_aoi : best.y.back());
    }
  }
  LinePlot plot{.title = curve.title,
                .x_label = thousands ? "updates (thousands)" : "updates",
                .y_label = "average AoI [slots]"};
  plot.curves = {flights, failures, best};
  if (curve.optimum_average_aoi) {
    plot.references = {{"exact optimum", CurveRole::kOptimum, *curve.optimum_average_aoi}};
    plot.gap_base = curve.optimum_average_aoi;
  }
  return plot;
}

}  // namespace fresco
