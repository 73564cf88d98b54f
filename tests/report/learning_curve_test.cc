#include "report/run_report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/files.h"
#include "tests/report/picture_files.h"
#include "tests/support/temporary_folder.h"

namespace fresco {
namespace {

const Curve& Named(const LinePlot& plot, const std::string& name) {
  return *std::find_if(plot.curves.begin(), plot.curves.end(),
                       [&](const Curve& curve) { return curve.name == name; });
}

LearningCurve SixFlights() {
  return {.title = "a run",
          .points = {{500, 9.5, false},
                     {1000, 20, true},
                     {1500, 22, true},
                     {2000, 11, false},
                     {2500, 15, true},
                     {3000, 18, true}},
          .optimum_average_aoi = 12.5};
}

TEST(LearningCurve, KeepsFlightsThatDidNotArriveApart) {
  const LinePlot plot = LearningCurvePlot(SixFlights());
  EXPECT_EQ(Named(plot, "did not arrive").x, (std::vector<double>{500, 2000}));
  const std::vector<double>& flights = Named(plot, "greedy flight").y;
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
  unknown.optimum_average_aoi.reset();
  EXPECT_TRUE(LearningCurvePlot(unknown).references.empty());
  EXPECT_FALSE(LearningCurvePlot(unknown).gap_base);
}

TEST(LearningCurve, CountsManyUpdatesInThousands) {
  LearningCurve curve = SixFlights();
  curve.points.push_back({544000, 14, true});
  const LinePlot plot = LearningCurvePlot(curve);
  EXPECT_EQ(plot.x_label, "updates (thousands)");
  EXPECT_EQ(Named(plot, "best so far").x.back(), 544);
  EXPECT_EQ(LearningCurvePlot(SixFlights()).x_label, "updates");
}

TEST(LearningCurve, DrawsHundredsOfFlights) {
  LearningCurve curve{.title = "long"};
  for (int i = 0; i < 700; ++i) {
    curve.points.push_back({i * 100, 13 + 700.0 / (i + 40) + (i * 37 % 11) * 0.1, i % 7 != 3});
  }
  const TemporaryFolder folder;
  WritePicture(DrawLinePlot(LearningCurvePlot(curve)), folder.path() / "curve");
  ASSERT_TRUE(ParsesAsXml(folder.path() / "curve.svg"));
  const std::string svg = ReadFile(folder.path() / "curve.svg");
  EXPECT_EQ(Count(svg, "<use xlink:href='#gpPt6'"), 600 + 1);  // discs: arrived, and the legend's
  EXPECT_EQ(Count(svg, "<use xlink:href='#gpPt1'"), 100 + 1);  // crosses: did not arrive
}

TEST(LearningCurve, CanBeDrawnBeforeAnyFlightHasArrived) {
  const LearningCurve curve{.title = "early", .points = {{100, 35, false}, {200, 30, false}}};
  const TemporaryFolder folder;
  WritePicture(DrawLinePlot(LearningCurvePlot(curve)), folder.path() / "curve");
  EXPECT_EQ(Count(ReadFile(folder.path() / "curve.svg"), "<use xlink:href='#gpPt1'"), 2 + 1);
}

}  // namespace
}  // namespace fresco
