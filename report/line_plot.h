// Draws curves over a common x axis, for example what policies reach against a parameter of the scenario, or
// the progress of a run. Pure functions; any thread may call them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "report/picture.h"

namespace fresco {

/// What a curve shows. The role decides its colour, marker and dashes in every figure.
enum class CurveRole : size_t {
  kDqn,
  kOptimum,
  kAoiBased,
  kDistanceBased,
  kSeries,  ///< the first of any number of alike curves (SeriesRole)
};

/// The role of alike curve `index`, 0, 1, ...: its colour is that of no other of the first six.
inline CurveRole SeriesRole(size_t index) {
  return static_cast<CurveRole>(static_cast<size_t>(CurveRole::kSeries) + index);
}

enum class CurveShape {
  kLineAndMarkers,  ///< a few measured points, joined by a line
  kMarkers,         ///< a few points without a line, since nothing is known between them
  kLine,
  kSteps,      ///< a line that keeps its value until the next point
  kFaintDots,  ///< many scattered values behind other curves; NaN in y interrupts their line
  kTopMarks,   ///< marks at x along the upper edge, for points that have no y
};

struct Curve {
  std::string name;  ///< its text in the legend
  CurveRole role = CurveRole::kDqn;
  CurveShape shape = CurveShape::kLineAndMarkers;
  std::vector<double> x{};  ///< finite
  std::vector<double> y{};  ///< one for each x, or empty for kTopMarks; finite, or NaN for kFaintDots
  std::vector<double> half_widths{};  ///< half of the spread for each x, in y's unit; 0 or NaN: not known;
                                      ///< may be empty
  double bars_aside = 0;  ///< shift of the bars along x, so that those of several curves do not overlap
};

/// A horizontal line over the whole width, for example a bound.
struct ReferenceLine {
  std::string name;
  CurveRole role = CurveRole::kOptimum;
  double y = 0;
};

struct LinePlot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<Curve> curves{};  ///< in the order of the legend; later ones are drawn over earlier ones
  std::vector<ReferenceLine> references{};
  bool integer_x_tics = false;
  /// The least possible y: the axis does not go below it, even if a spread does.
  std::optional<double> least_y{};
  /// If set (> 0), an axis on the right shows how far a value is above it, in percent.
  std::optional<double> gap_base{};
};

/// Draws the plot. At least one curve must have a point.
Picture DrawLinePlot(const LinePlot& plot);

}  // namespace fresco
