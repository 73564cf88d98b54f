#include "report/run_report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/files.h"
#include "tests/report/picture_files.h"
#include "tests/support/temporary_folder.h"
#include "tests/worlds/test_scenarios.h"
#include "worlds/cartpole/cartpole.h"
#include "worlds/uav/uav_world.h"

namespace fresco {
namespace {

const Curve& Named(const LinePlot& plot, const std::string& name) {
  return *std::find_if(plot.curves.begin(), plot.curves.end(),
                       [&](const Curve& curve) { return curve.name == name; });
}

const WorldDescription& UavDescription() {
  static const UavWorld world(TableOneScenario());
  return world.description();
}

LearningCurve SixFlights() {
  return {
      .title = "a run",
      .world = UavDescription(),
      .points = {{500, 9.5, 0}, {1000, 20, 1}, {1500, 22, 1}, {2000, 11, 0}, {2500, 15, 1}, {3000, 18, 1}},
      .optimum_score = 12.5};
}

TEST(LearningCurve, KeepsFlightsThatDidNotArriveApart) {
  const LinePlot plot = LearningCurvePlot(SixFlights());
  EXPECT_EQ(Named(plot, "not arrived").x, (std::vector<double>{500, 2000}));
  const std::vector<double>& flights = Named(plot, "greedy episode").y;
  ASSERT_EQ(flights.size(), 6U);
  EXPECT_TRUE(std::isnan(flights[0]));
  EXPECT_EQ(flights[1], 20);
  EXPECT_EQ(flights[2], 22);
  EXPECT_TRUE(std::isnan(flights[3]));
  EXPECT_EQ(flights[4], 15);
  EXPECT_EQ(flights[5], 18);
}

TEST(LearningCurve, FollowsTheBestOfThoseThatArrived) {
  const LinePlot plot = LearningCurvePlot(SixFlights());
  const Curve& best = Named(plot, "best so far");
  EXPECT_EQ(best.x, (std::vector<double>{1000, 2500, 3000}));
  EXPECT_EQ(best.y, (std::vector<double>{20, 15, 15}));
}

TEST(LearningCurve, MeasuresTheGapFromTheOptimum) {
  const LinePlot plot = LearningCurvePlot(SixFlights());
  ASSERT_EQ(plot.references.size(), 1U);
  EXPECT_EQ(plot.references[0].y, 12.5);
  EXPECT_EQ(plot.gap_base, 12.5);
  LearningCurve unknown = SixFlights();
  unknown.optimum_score.reset();
  EXPECT_TRUE(LearningCurvePlot(unknown).references.empty());
  EXPECT_FALSE(LearningCurvePlot(unknown).gap_base);
}

TEST(LearningCurve, NamesTheScoreAndItsUnit) {
  EXPECT_EQ(LearningCurvePlot(SixFlights()).y_label, "average AoI [slots]");
}

/// In a world with chance, every evaluation has a score; in CartPole, more is better.
TEST(CartPoleLearningCurve, ShowsEveryEvaluationAndFollowsTheBest) {
  const LearningCurve curve{
      .title = "a run",
      .world = CartPole(500).description(),
      .points = {{100, 9.5, 0}, {200, 200, 0.25}, {300, 180, 0}, {400, 500, 1}, {500, 450, 0.5}}};
  const LinePlot plot = LearningCurvePlot(curve);
  EXPECT_EQ(plot.y_label, "return");
  EXPECT_EQ(Named(plot, "mean of greedy episodes").y, (std::vector<double>{9.5, 200, 180, 500, 450}));
  EXPECT_EQ(Named(plot, "best so far").x, (std::vector<double>{100, 200, 400, 500}));
  EXPECT_EQ(Named(plot, "best so far").y, (std::vector<double>{9.5, 200, 500, 500}));
  EXPECT_TRUE(Named(plot, "not balanced").x.empty());
  EXPECT_TRUE(plot.references.empty());
  EXPECT_FALSE(plot.gap_base);
}

TEST(CartPoleLearningCurve, CanBeDrawn) {
  const LearningCurve curve{
      .title = "a run", .world = CartPole(500).description(), .points = {{100, 9.5, 0}, {200, 200, 0.25}}};
  const TemporaryFolder folder;
  WritePicture(DrawLinePlot(LearningCurvePlot(curve)), folder.path() / "curve");
  ASSERT_TRUE(ParsesAsXml(folder.path() / "curve.svg"));
  EXPECT_EQ(Count(ReadFile(folder.path() / "curve.svg"), "<use xlink:href='#gpPt6'"), 2 + 1);
}

TEST(LearningCurve, CountsManyUpdatesInThousands) {
  LearningCurve curve = SixFlights();
  curve.points.push_back({544000, 14, 1});
  const LinePlot plot = LearningCurvePlot(curve);
  EXPECT_EQ(plot.x_label, "updates (thousands)");
  EXPECT_EQ(Named(plot, "best so far").x.back(), 544);
  EXPECT_EQ(LearningCurvePlot(SixFlights()).x_label, "updates");
}

TEST(LearningCurve, DrawsHundredsOfFlights) {
  LearningCurve curve{.title = "long", .world = UavDescription()};
  for (int i = 0; i < 700; ++i) {
    curve.points.push_back({i * 100, 13 + 700.0 / (i + 40) + (i * 37 % 11) * 0.1, i % 7 != 3 ? 1.0 : 0.0});
  }
  const TemporaryFolder folder;
  WritePicture(DrawLinePlot(LearningCurvePlot(curve)), folder.path() / "curve");
  ASSERT_TRUE(ParsesAsXml(folder.path() / "curve.svg"));
  const std::string svg = ReadFile(folder.path() / "curve.svg");
  EXPECT_EQ(Count(svg, "<use xlink:href='#gpPt6'"), 600 + 1);  // discs: arrived, and the legend's
  EXPECT_EQ(Count(svg, "<use xlink:href='#gpPt1'"), 100 + 1);  // crosses: did not arrive
}

TEST(LearningCurve, CanBeDrawnBeforeAnyFlightHasArrived) {
  const LearningCurve curve{
      .title = "early", .world = UavDescription(), .points = {{100, 35, 0}, {200, 30, 0}}};
  const TemporaryFolder folder;
  WritePicture(DrawLinePlot(LearningCurvePlot(curve)), folder.path() / "curve");
  EXPECT_EQ(Count(ReadFile(folder.path() / "curve.svg"), "<use xlink:href='#gpPt1'"), 2 + 1);
}

}  // namespace
}  // namespace fresco
