#include "report/line_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace fresco {
namespace {

constexpr int kPlotWidthPx = 800;
constexpr int kPlotHeightPx = 470;  // height without the legend
constexpr int kGapAxisPx = 92;

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
    case CurveRole::kSeries:
      break;
  }
  constexpr const char* kColours[] = {colour::kBlue,   colour::kVermillion, colour::kGreen,
                                      colour::kPurple, colour::kOrange,     colour::kSkyBlue};
  constexpr const char* kDashes[] = {"", "dashtype (9,5)", "dashtype (2,4)"};
  const size_t index = static_cast<size_t>(role) - static_cast<size_t>(CurveRole::kSeries);
  return {kColours[index % std::size(kColours)], 7, 0.65, 2,
          kDashes[index / std::size(kColours) % std::size(kDashes)]};
}

/// gnuplot's options for a curve.
struct CurveLooks {
  std::string colour;
  std::string line;   // empty: no line
  std::string point;  // empty: no points
  const char* plotting_style;
};

CurveLooks LooksOf(CurveRole role, CurveShape shape) {
  const RoleStyle style = StyleOf(role);
  const std::string colour = fmt::format("linecolor rgb '#00{}'", style.colour + 1);
  const std::string line = fmt::format("linewidth {} {}", style.line_width, style.dashes);
  const std::string marker = fmt::format("pointtype {} pointsize {}", style.marker, style.marker_size);
  switch (shape) {
    case CurveShape::kLineAndMarkers:
      return {colour, line, marker, "linespoints"};
    case CurveShape::kMarkers:
      return {colour, "", marker, "points"};
    case CurveShape::kLine:
      return {colour, line, "", "lines"};
    case CurveShape::kSteps:
      return {colour, line, "", "steps"};
    case CurveShape::kFaintDots:  // the first two digits are the transparency
      return {fmt::format("linecolor rgb '#90{}'", style.colour + 1), "linewidth 0.8",
              "pointtype 7 pointsize 0.3", "linespoints"};
    case CurveShape::kTopMarks:
      return {colour, "", "pointtype 2 pointsize 0.55 linewidth 1.2", "points"};
  }
  FRESCO_CHECK(false);
}

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void Add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  /// Widens the range, so that there is room for markers on both sides.
  Range Padded(double low_share, double high_share) const {
    if (!(low <= high)) {
      return {0, 1};
    }
    const double width = high > low ? high - low : std::max(1.0, std::abs(high) * 0.1);
    return {low - low_share * width, high + high_share * width};
  }
};

double HalfWidth(const Curve& curve, size_t i) {
  const double width = curve.half_widths.empty() ? 0 : curve.half_widths[i];
  return width > 0 ? width : 0;
}

bool HasSpread(const Curve& curve) {
  return std::any_of(curve.half_widths.begin(), curve.half_widths.end(),
                     [](double width) { return width > 0; });
}

void CheckCurve(const Curve& curve) {
  const bool has_y = curve.shape != CurveShape::kTopMarks;
  FRESCO_CHECK(curve.y.size() == (has_y ? curve.x.size() : 0));
  FRESCO_CHECK(curve.half_widths.empty() || (has_y && curve.half_widths.size() == curve.x.size()));
  for (size_t i = 0; i < curve.x.size(); ++i) {
    FRESCO_CHECK(std::isfinite(curve.x[i]));
    FRESCO_CHECK(!has_y || std::isfinite(curve.y[i]) || curve.shape == CurveShape::kFaintDots);
    FRESCO_CHECK(!std::isinf(HalfWidth(curve, i)));
  }
}

Range XRange(const LinePlot& plot) {
  Range range;
  for (const Curve& curve : plot.curves) {
    for (const double x : curve.x) {
      range.Add(x);
      range.Add(x + (HasSpread(curve) ? curve.bars_aside : 0));
    }
  }
  return range.Padded(0.03, 0.03);
}

Range YRange(const LinePlot& plot) {
  Range range;
  bool top_marks = false;
  for (const Curve& curve : plot.curves) {
    for (size_t i = 0; i < curve.y.size(); ++i) {
      if (std::isfinite(curve.y[i])) {
        range.Add(curve.y[i] - HalfWidth(curve, i));
        range.Add(curve.y[i] + HalfWidth(curve, i));
      }
    }
    top_marks = top_marks || (curve.shape == CurveShape::kTopMarks && !curve.x.empty());
  }
  for (const ReferenceLine& reference : plot.references) {
    range.Add(reference.y);
  }
  Range padded = range.Padded(0.05, top_marks ? 0.1 : 0.05);
  padded.low = std::max(padded.low, plot.least_y.value_or(padded.low));
  return padded;
}

/// Returns a step between tics of 1, 2 or 5 times a power of ten, at least one, so that the range has at most
/// ten tics.
double IntegerStep(Range range) {
  double step = 1;
  for (int i = 0; (range.high - range.low) / step > 10; ++i) {
    step *= i % 3 == 1 ? 2.5 : 2;
  }
  return step;
}

/// The data of a curve, a line for each point: x, y, half of the spread.
std::string DataScript(const Curve& curve, size_t number, double top_y) {
  std::string script = fmt::format("$curve{} << END\n", number);
  for (size_t i = 0; i < curve.x.size(); ++i) {
    const double y = curve.shape == CurveShape::kTopMarks ? top_y : curve.y[i];
    script += std::isfinite(y) ? fmt::format("{} {} {}\n", curve.x[i], y, HalfWidth(curve, i)) : "\n";
  }
  return script + "END\n";
}

std::string SpreadCommand(const Curve& curve, size_t number) {
  // Vectors instead of yerrorbars, which leave a gap around the point even if no point is drawn.
  return fmt::format(
      "$curve{} using ($1+{}):($3>0?$2-$3:NaN):(0):(2*$3) with vectors heads size graph 0.005,90 "
      "linewidth 1.1 {}",
      number, curve.bars_aside, LooksOf(curve.role, CurveShape::kLine).colour);
}

std::string CurveCommand(const Curve& curve, size_t number) {
  const CurveLooks looks = LooksOf(curve.role, curve.shape);
  return fmt::format("$curve{} using 1:2 with {} {} {} {}", number, looks.plotting_style, looks.colour,
                     looks.line, looks.point);
}

Legend MakeLegend(const LinePlot& plot) {
  std::vector<LegendEntry> entries;
  const auto add = [&](const std::string& name, const CurveLooks& looks) {
    entries.push_back({name, looks.colour, looks.line, looks.point});
  };
  for (const Curve& curve : plot.curves) {
    if (!curve.x.empty()) {
      add(curve.name, LooksOf(curve.role, curve.shape));
    }
  }
  for (const ReferenceLine& reference : plot.references) {
    add(reference.name, LooksOf(reference.role, CurveShape::kLine));
  }
  return Legend(std::move(entries), kPlotWidthPx);
}

std::string AxesScript(const LinePlot& plot, Range x, Range y) {
  std::string script =
      fmt::format("set border {} linewidth 1 linecolor rgb '{}'\n", plot.gap_base ? 11 : 3, colour::kText);
  script += fmt::format("set grid ytics linetype 1 linewidth 0.7 linecolor rgb '{}'\n", colour::kGrid);
  script += fmt::format("set xrange [{}:{}]\nset yrange [{}:{}]\n", x.low, x.high, y.low, y.high);
  for (const ReferenceLine& reference : plot.references) {
    const CurveLooks looks = LooksOf(reference.role, CurveShape::kLine);
    script += fmt::format("set arrow from graph 0, first {0} to graph 1, first {0} nohead front {1} {2}\n",
                          reference.y, looks.colour, looks.line);
  }
  if (plot.integer_x_tics) {
    script += fmt::format("set xtics {}\n", IntegerStep(x));
  }
  if (plot.gap_base) {
    const double base = *plot.gap_base;
    script += fmt::format("set y2range [{}:{}]\nset y2tics format '%g %%'\n", (y.low / base - 1) * 100,
                          (y.high / base - 1) * 100);
  }
  return script;
}

std::string PlotCommand(const LinePlot& plot) {
  std::vector<std::string> commands;
  for (size_t i = 0; i < plot.curves.size(); ++i) {
    if (HasSpread(plot.curves[i])) {
      commands.push_back(SpreadCommand(plot.curves[i], i));
    }
  }
  for (size_t i = 0; i < plot.curves.size(); ++i) {
    if (!plot.curves[i].x.empty()) {
      commands.push_back(CurveCommand(plot.curves[i], i));
    }
  }
  FRESCO_CHECK(!commands.empty());
  return fmt::format("plot {}\n", fmt::join(commands, ", \\\n  "));
}

}  // namespace

Picture DrawLinePlot(const LinePlot& plot) {
  FRESCO_CHECK(!plot.gap_base || *plot.gap_base > 0);
  std::for_each(plot.curves.begin(), plot.curves.end(), CheckCurve);
  const Range x = XRange(plot);
  const Range y = YRange(plot);
  const Legend legend = MakeLegend(plot);
  Picture picture{kPlotWidthPx, kPlotHeightPx + legend.height_px(), ""};
  Frame frame{.title = plot.title, .x_label = plot.x_label, .y_label = plot.y_label};
  if (plot.gap_base) {
    frame.right_px = kGapAxisPx;
    frame.right_label = "above the optimum";
  }
  picture.script = FrameScript(frame, picture, legend) + AxesScript(plot, x, y);
  constexpr double kTopMarkShare = 0.965;
  for (size_t i = 0; i < plot.curves.size(); ++i) {
    picture.script += DataScript(plot.curves[i], i, y.low + kTopMarkShare * (y.high - y.low));
  }
  picture.script += PlotCommand(plot);
  return picture;
}

}  // namespace fresco
