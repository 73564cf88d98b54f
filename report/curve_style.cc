#include "report/curve_style.h"

#include <fmt/format.h>

#include "core/error.h"
#include "report/picture.h"

namespace fresco {
namespace {

struct RoleStyle {
  const char* colour;
  int marker;
  double marker_size;
  double line_width;
  const char* dashes;
};

/// The optimum's marker is open and larger, so that it stays visible around the marker of a curve that
/// reaches it.
RoleStyle StyleOf(CurveRole role) {
  switch (role) {
    case CurveRole::kDqn:
      return {colour::kBlue, 7, 0.65, 2.4, ""};
    case CurveRole::kOptimum:
      return {colour::kBlack, 4, 1.05, 1.4, "dashtype (9,5)"};
    case CurveRole::kAoiBased:
      return {colour::kVermillion, 9, 0.75, 1.8, ""};
    case CurveRole::kDistanceBased:
      return {colour::kGreen, 13, 0.8, 1.8, ""};
    case CurveRole::kFirstVariant:
      return {colour::kOrange, 11, 0.75, 1.8, ""};
    case CurveRole::kSecondVariant:
      return {colour::kPurple, 5, 0.6, 1.8, ""};
    case CurveRole::kThirdVariant:
      return {colour::kSkyBlue, 15, 0.75, 1.8, ""};
  }
  FRESCO_CHECK(false);
}

}  // namespace

std::string ColourOption(CurveRole role, int transparency) {
  return fmt::format("linecolor rgb '#{:02X}{}'", transparency, StyleOf(role).colour + 1);
}

std::string ColourOption(CurveRole role, CurveShape shape) {
  constexpr int kFaint = 0x90;
  return ColourOption(role, shape == CurveShape::kFaintDots ? kFaint : 0);
}

std::string LineOptions(CurveRole role, CurveShape shape) {
  const RoleStyle style = StyleOf(role);
  switch (shape) {
    case CurveShape::kMarkers:
    case CurveShape::kTopMarks:
      return "";
    case CurveShape::kFaintDots:
      return "linewidth 0.8";
    default:
      return fmt::format("linewidth {} {}", style.line_width, style.dashes);
  }
}

std::string PointOptions(CurveRole role, CurveShape shape) {
  const RoleStyle style = StyleOf(role);
  switch (shape) {
    case CurveShape::kLineAndMarkers:
    case CurveShape::kMarkers:
      return fmt::format("pointtype {} pointsize {}", style.marker, style.marker_size);
    case CurveShape::kFaintDots:
      return "pointtype 7 pointsize 0.3";
    case CurveShape::kTopMarks:
      return "pointtype 2 pointsize 0.55 linewidth 1.2";
    default:
      return "";
  }
}

const char* PlottingStyle(CurveShape shape) {
  switch (shape) {
    case CurveShape::kLineAndMarkers:
    case CurveShape::kFaintDots:
      return "linespoints";
    case CurveShape::kLine:
      return "lines";
    case CurveShape::kSteps:
      return "steps";
    case CurveShape::kMarkers:
    case CurveShape::kTopMarks:
      return "points";
  }
  FRESCO_CHECK(false);
}

}  // namespace fresco
