#include "report/line_plot.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/files.h"
#include "tests/report/picture_files.h"
#include "tests/support/temporary_folder.h"

namespace fresco {
namespace {

LinePlot TwoCurves() {
  LinePlot plot{.title = "Effect of R", .x_label = "radius [cells]", .y_label = "average AoI [slots]"};
  plot.curves = {{.name = "AoI-based",
                  .role = CurveRole::kAoiBased,
                  .x = {1, 2, 3, 4},
                  .y = {0.1 + 0.2, 1.0 / 3, 17.542857142857144, 1e-7},
                  .half_widths = {0.25, 0, std::nan(""), 1.0 / 7}},
                 {.name = "DQN", .role = CurveRole::kDqn, .x = {1, 2, 3}, .y = {5, 4, 3}}};
  return plot;
}

std::string Svg(const LinePlot& plot, bool parse = false) {
  const TemporaryFolder folder;
  WritePicture(DrawLinePlot(plot), folder.path() / "plot");
  EXPECT_TRUE(!parse || ParsesAsXml(folder.path() / "plot.svg"));
  EXPECT_EQ(PngSize(ReadFile(folder.path() / "plot.png")).first, 1600U);
  return ReadFile(folder.path() / "plot.svg");
}

TEST(LinePlot, DrawsExactlyTheNumbersItWasGiven) {
  const std::string script = DrawLinePlot(TwoCurves()).script;
  EXPECT_EQ(DataBlock(script, "curve0"),
            (std::vector<std::vector<double>>{
                {1, 0.1 + 0.2, 0.25}, {2, 1.0 / 3, 0}, {3, 17.542857142857144, 0}, {4, 1e-7, 1.0 / 7}}));
  EXPECT_EQ(DataBlock(script, "curve1"), (std::vector<std::vector<double>>{{1, 5, 0}, {2, 4, 0}, {3, 3, 0}}));
}

TEST(LinePlot, ShowsEveryTextAndEveryPoint) {
  const std::string svg = Svg(TwoCurves(), true);
  for (const char* text : {"Effect of R", "radius [cells]", "average AoI [slots]", "AoI-based", "DQN"}) {
    EXPECT_EQ(Count(svg, std::string("<text>") + text + "</text>"), 1) << text;
  }
  // Triangles and discs: a point each, and one in the legend.
  EXPECT_EQ(Count(svg, "<use xlink:href='#gpPt8'"), 4 + 1);
  EXPECT_EQ(Count(svg, "<use xlink:href='#gpPt6'"), 3 + 1);
}

TEST(LinePlot, GivesARoleTheSameLooksInEveryFigure) {
  LinePlot other = TwoCurves();
  std::swap(other.curves[0], other.curves[1]);
  other.curves[0].name = "network";
  const std::string svg = Svg(other);
  EXPECT_EQ(Count(svg, "<use xlink:href='#gpPt8'"), 4 + 1);
  EXPECT_EQ(Count(svg, "<use xlink:href='#gpPt6'"), 3 + 1);
}

TEST(LinePlot, DrawsErrorBarsOnlyWhereTheSpreadIsKnown) {
  LinePlot plot = TwoCurves();
  const std::string with_two = Svg(plot);
  plot.curves[0].half_widths.clear();
  const std::string without = Svg(plot);
  plot.curves[0].half_widths = {0, 0, 0, 0};
  EXPECT_EQ(Count(Svg(plot), "<g id=\"fresco_plot_"), 2);
  EXPECT_EQ(Count(without, "<g id=\"fresco_plot_"), 2);
  EXPECT_EQ(Count(with_two, "<g id=\"fresco_plot_"), 3);
}

TEST(LinePlot, KeepsTheAxisAboveTheLeastPossibleValue) {
  LinePlot plot = TwoCurves();
  plot.curves[0].half_widths = {40, 0, 0, 0};
  EXPECT_EQ(Count(DrawLinePlot(plot).script, "set yrange [0:"), 0);
  plot.least_y = 0;
  EXPECT_EQ(Count(DrawLinePlot(plot).script, "set yrange [0:"), 1);
  plot.least_y = -1000;  // far below: no empty space is shown
  EXPECT_EQ(Count(DrawLinePlot(plot).script, "set yrange [-1000:"), 0);
}

TEST(LinePlot, HasTicsOnWholeNumbersOnly) {
  LinePlot plot = TwoCurves();
  plot.integer_x_tics = true;
  plot.curves[0].half_widths.clear();
  const std::string svg = Svg(plot);
  EXPECT_EQ(Count(svg, "<text>2.5</text>"), 0);
  for (const char* tic : {"1", "2", "3", "4"}) {
    EXPECT_GE(Count(svg, std::string("<text>") + tic + "</text>"), 1) << tic;
  }
}

TEST(LinePlot, ShowsTheGapToABaseOnTheRight) {
  LinePlot plot = TwoCurves();
  plot.curves.erase(plot.curves.begin());  // 3 to 5 remain
  plot.references = {{"exact optimum", CurveRole::kOptimum, 2.5}};
  plot.gap_base = 2.5;
  const std::string svg = Svg(plot);
  EXPECT_EQ(Count(svg, "<text>exact optimum</text>"), 1);
  EXPECT_EQ(Count(svg, "<text>0 %</text>"), 1);
  EXPECT_EQ(Count(svg, "<text>100 %</text>"), 1);  // 5 is twice 2.5
  EXPECT_EQ(Count(svg, "<text>140 %</text>"), 0);
}

TEST(LinePlot, DrawsASinglePoint) {
  LinePlot plot = TwoCurves();
  plot.curves = {{.name = "DQN", .role = CurveRole::kDqn, .x = {4}, .y = {13.3}}};
  EXPECT_EQ(Count(Svg(plot), "<use xlink:href='#gpPt6'"), 1 + 1);
}

TEST(LinePlotDeathTest, RefusesCurvesThatDoNotFit) {
  LinePlot plot = TwoCurves();
  plot.curves[1].y.pop_back();
  EXPECT_DEATH(DrawLinePlot(plot), "y.size");
  EXPECT_DEATH(DrawLinePlot({.title = "", .x_label = "", .y_label = ""}), "commands");
}

}  // namespace
}  // namespace fresco
