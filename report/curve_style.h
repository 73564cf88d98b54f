// Defines what curves look like, in the same way for every figure. Pure functions; any thread may call them.
#pragma once

#include <string>

namespace fresco {

/// What a curve shows. The role decides its colour, marker and dashes in every figure.
enum class CurveRole {
  kDqn,
  kOptimum,
  kAoiBased,
  kDistanceBased,
  kFirstVariant,  ///< a variant of the agent, if a figure compares several
  kSecondVariant,
  kThirdVariant,
};

enum class CurveShape {
  kLineAndMarkers,  ///< a few measured points, joined by a line
  kMarkers,         ///< a few points without a line, since nothing is known between them
  kLine,
  kSteps,      ///< a line that keeps its value until the next point
  kFaintDots,  ///< many scattered values behind other curves; NaN in y interrupts their line
  kTopMarks,   ///< marks at x along the upper edge, for points that have no y
};

/// Return gnuplot's options for the colour (transparency 0 .. 255, 0: opaque), for the line and for the
/// points. They are empty if the shape has no line or no points.
std::string ColourOption(CurveRole role, int transparency);
std::string ColourOption(CurveRole role, CurveShape shape);
std::string LineOptions(CurveRole role, CurveShape shape);
std::string PointOptions(CurveRole role, CurveShape shape);

/// Returns gnuplot's plotting style for the shape: "lines", "points", ...
const char* PlottingStyle(CurveShape shape);

}  // namespace fresco
