// Curves over a common x axis: what a policy reaches against a parameter of the scenario, or a run's
// progress. Pure; any thread.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/curve_style.h"
#include "report/picture.h"

namespace fresco {

enum class Spread { kBars, kBand };

struct Curve {
  std::string name;  ///< in the legend
  CurveRole role = CurveRole::kDqn;
  CurveShape shape = CurveShape::kLineAndMarkers;
  std::vector<double> x{};            ///< finite
  std::vector<double> y{};            ///< as many as x (none for kTopMarks); finite but for kFaintDots
  std::vector<double> half_widths{};  ///< none, or as many as x, in y's unit; 0 or NaN: not known there
  Spread spread = Spread::kBars;
  double bars_aside = 0;  ///< how far beside their points the bars stand, in x's unit: to tell curves apart
};

/// A horizontal line over the whole width, such as a bound.
struct ReferenceLine {
  std::string name;
  CurveRole role = CurveRole::kOptimum;
  double y = 0;
};

struct LinePlot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<Curve> curves{};  ///< later ones are drawn over earlier ones; the legend has their order
  std::vector<ReferenceLine> references{};
  bool integer_x_tics = false;
  /// y can't be smaller: the axis does not go below it, though a spread might.
  std::optional<double> least_y{};
  /// Positive: the axis on the right shows how much above it a value is, in percent.
  std::optional<double> gap_base{};
};

/// At least one curve must have a point.
Picture DrawLinePlot(const LinePlot& plot);

}  // namespace fresco
