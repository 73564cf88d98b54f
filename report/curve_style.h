// The looks of curves, the same in every figure. Pure; any thread.
#pragma once

#include <string>

namespace fresco {

/// What a curve is about; it has the same colour, marker and dashes in every figure.
enum class CurveRole {
  kDqn,
  kOptimum,
  kAoiBased,
  kDistanceBased,
  kFirstVariant,  ///< of the agent, where a figure compares several
  kSecondVariant,
  kThirdVariant,
};

enum class CurveShape {
  kLineAndMarkers,  ///< a few points that were measured, joined for the eye
  kMarkers,         ///< a few points between which nothing is known
  kLine,
  kSteps,      ///< keeps its value until the next point
  kFaintDots,  ///< many scattered values behind other curves; NaN in y interrupts their line
  kTopMarks,   ///< at their x along the upper edge: they have no y
};

/// gnuplot's options for the colour (transparency: 0, opaque, to 255), for the line and for the points;
/// empty where the shape has no line or no points.
std::string ColourOption(CurveRole role, int transparency);
std::string ColourOption(CurveRole role, CurveShape shape);
std::string LineOptions(CurveRole role, CurveShape shape);
std::string PointOptions(CurveRole role, CurveShape shape);

/// The plotting style that draws the shape: "lines", "points", ...
const char* PlottingStyle(CurveShape shape);

}  // namespace fresco
