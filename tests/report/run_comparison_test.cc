#include "report/run_comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/files.h"
#include "tests/support/error_of.h"
#include "tests/support/temporary_folder.h"

namespace fresco {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class RunComparisonTest : public ::testing::Test {
 protected:
  /// Writes what a run leaves behind that has reached a score; its optimum is 10.
  std::filesystem::path AddRun(const std::string& name, double score, const std::string& configuration) {
    const std::filesystem::path folder = folder_.path() / name;
    std::filesystem::create_directories(folder);
    WriteFileAtomically(folder / "config.textproto", Experiment::Parse(configuration, "a test").Text());
    const nlohmann::json summary = {{"score", score},
                                    {"success", 1},
                                    {"gap_percent", (score / 10 - 1) * 100},
                                    {"average_aoi", score},
                                    {"optimal_average_aoi", 10},
                                    {"updates", 3000},
                                    {"wall_s", 12.3},
                                    {"completed", true},
                                    {"weights_crc32c", "0123abcd"}};
    WriteFileAtomically(folder / "summary.json", summary.dump());
    WriteFileAtomically(folder / "metrics.csv", "updates,average_aoi,arrived\n1000," +
                                                    std::to_string(score + 2) + ",1\n2000," +
                                                    std::to_string(score) + ",1\n3000,99,1\n");
    return folder;
  }

  const TemporaryFolder folder_;
};

TEST_F(RunComparisonTest, ShowsResultsAndDifferentSettings) {
  const RunComparison comparison({AddRun("wide", 11, "agent { hidden_layers: [256, 256] }"),
                                  AddRun("narrow", 12.5, "agent { hidden_layers: [64] batch_size: 32 }")});
  const std::vector<ReportTable> tables = comparison.Tables();
  ASSERT_EQ(tables.size(), 2U);
  EXPECT_THAT(tables[0].rows,
              ElementsAre(ElementsAre("wide", "11.000", "10.00 %", "100 %", "3000", "12 s", "0123abcd"),
                          ElementsAre("narrow", "12.500", "25.00 %", "100 %", "3000", "12 s", "0123abcd")));
  EXPECT_THAT(tables[1].header, ElementsAre("setting", "wide", "narrow"));
  EXPECT_THAT(tables[1].rows, ElementsAre(ElementsAre("agent.batch_size", "200", "32"),
                                          ElementsAre("agent.hidden_layers", "256,256", "64")));
  EXPECT_THAT(comparison.Text(), HasSubstr("agent.hidden_layers  256,256      64"));
}

TEST_F(RunComparisonTest, GivesMeansOverSeeds) {
  const RunComparison comparison({AddRun("a1", 11, "schedule { seed: 1 }"),
                                  AddRun("a2", 13, "schedule { seed: 2 }"),
                                  AddRun("b1", 10, "schedule { seed: 1 episodes: 77 }"),
                                  AddRun("a3", 12, "schedule { seed: 3 } run { actors: 7 }")});
  const ReportTable seeds = comparison.Tables()[1];
  // By hand: s = 1, t(0.975; 2) = 4.302653, half = t / sqrt(3) = 2.484.
  EXPECT_THAT(seeds.rows, ElementsAre(ElementsAre("a1, a2, a3", "3", "12.000 ± 2.484", "20.000 ± 24.841 %")));
  const auto json = nlohmann::json::parse(comparison.Json());
  EXPECT_EQ(json["runs"][1]["run"], "a2");
  EXPECT_EQ(json["runs"][1]["score"], 13);
  EXPECT_NEAR(json["seeds"][0]["score_half_width"].get<double>(), 2.484, 0.001);
  EXPECT_EQ(json["settings"]["schedule.episodes"][2], "77");
}

TEST_F(RunComparisonTest, DrawsTheBestSoFar) {
  const RunComparison comparison({AddRun("a", 11, ""), AddRun("b", 13, "agent { batch_size: 8 }")});
  const LinePlot plot = comparison.CurvesPlot();
  ASSERT_EQ(plot.curves.size(), 2U);
  EXPECT_EQ(plot.curves[0].name, "a");
  EXPECT_THAT(plot.curves[0].x, ElementsAre(1000, 2000, 3000));
  EXPECT_THAT(plot.curves[0].y, ElementsAre(13, 11, 11));
  EXPECT_THAT(plot.curves[1].y, ElementsAre(15, 13, 13));
  EXPECT_EQ(plot.references.front().y, 10);
  const RunComparison other_fields({AddRun("c", 11, "scenario { slots: 60 }"), AddRun("d", 13, "")});
  EXPECT_TRUE(other_fields.CurvesPlot().references.empty());
}

TEST_F(RunComparisonTest, NamesRunsByAsMuchOfThePathAsItTakes) {
  const RunComparison comparison({AddRun("x/run", 11, ""), AddRun("y/run", 12, "")});
  EXPECT_THAT(comparison.Tables()[0].rows[0][0], HasSubstr("x/run"));
}

TEST_F(RunComparisonTest, RefusesRunsOfOtherFigures) {
  const auto uav = AddRun("uav", 11, "");
  const auto pole = folder_.path() / "pole";
  std::filesystem::create_directories(pole);
  WriteFileAtomically(pole / "config.textproto", Experiment::Parse("cartpole {}", "a test").Text());
  WriteFileAtomically(pole / "summary.json", "{}");
  EXPECT_THAT(ErrorOf([&] {
                RunComparison({uav, pole});
              }),
              testing::AllOf(HasSubstr("judged by the same figure"), HasSubstr("average AoI [slots]")));
}

TEST_F(RunComparisonTest, RefusesAFolderWithoutAFinishedRun) {
  EXPECT_THAT(ErrorOf([&] { RunComparison({folder_.path() / "none"}); }), HasSubstr("expected the folder of a run that has ended"));
}

}  // namespace
}  // namespace fresco
