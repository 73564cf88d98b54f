#include "report/run_comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/files.h"
#include "storage/network_file.h"
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

  std::filesystem::path AddPole(const std::string& name) {
    const auto folder = AddRun(name, 400, "cartpole {}");
    WriteFileAtomically(folder / "metrics.csv", "updates,return,balanced\n1000,400,0.5\n");
    return folder;
  }

  /// Changes a number of a run's summary.
  static void Change(const std::filesystem::path& run, const char* name, const nlohmann::json& value) {
    nlohmann::json summary = nlohmann::json::parse(ReadFile(run / "summary.json"));
    summary[name] = value;
    WriteFileAtomically(run / "summary.json", summary.dump());
  }

  static RunComparison OnlyOne(const std::vector<std::filesystem::path>& folders) {
    std::vector<RunComparison> comparisons = CompareRuns(folders);
    EXPECT_EQ(comparisons.size(), 1U);
    return comparisons.front();
  }

  const TemporaryFolder folder_;
};

TEST_F(RunComparisonTest, ShowsResultsAndDifferentSettings) {
  const RunComparison comparison =
      OnlyOne({AddRun("wide", 11, "agent { hidden_layers: [256, 256] }"),
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
  const RunComparison comparison =
      OnlyOne({AddRun("a1", 11, "schedule { seed: 1 }"), AddRun("a2", 13, "schedule { seed: 2 }"),
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
  const RunComparison comparison = OnlyOne({AddRun("a", 11, ""), AddRun("b", 13, "agent { batch_size: 8 }")});
  const LinePlot plot = comparison.CurvesPlot();
  ASSERT_EQ(plot.curves.size(), 2U);
  EXPECT_EQ(plot.curves[0].name, "a");
  EXPECT_THAT(plot.curves[0].x, ElementsAre(1000, 2000, 3000));
  EXPECT_THAT(plot.curves[0].y, ElementsAre(13, 11, 11));
  EXPECT_THAT(plot.curves[1].y, ElementsAre(15, 13, 13));
  EXPECT_EQ(plot.references.front().y, 10);
  const auto other_optimum = AddRun("c", 11, "scenario { slots: 60 }");
  Change(other_optimum, "optimal_average_aoi", 9);
  const RunComparison other_fields = OnlyOne({other_optimum, AddRun("d", 13, "")});
  EXPECT_TRUE(other_fields.CurvesPlot().references.empty());
}

TEST_F(RunComparisonTest, NamesRunsByAsMuchOfThePathAsItTakes) {
  const RunComparison comparison = OnlyOne({AddRun("x/run", 11, ""), AddRun("y/run", 12, "")});
  EXPECT_THAT(comparison.Tables()[0].rows[0][0], HasSubstr("x/run"));
}

TEST_F(RunComparisonTest, KeepsKindsOfWorldsApart) {
  const std::vector<RunComparison> comparisons =
      CompareRuns({AddRun("uav", 11, ""), AddPole("pole"), AddRun("uav-2", 12, "")});
  ASSERT_EQ(comparisons.size(), 2U);
  EXPECT_EQ(comparisons[0].world_name(), "uav");
  EXPECT_EQ(comparisons[0].Tables()[0].rows.size(), 2U);
  EXPECT_EQ(comparisons[1].world_name(), "cartpole");
}

TEST_F(RunComparisonTest, LeavesOutWhatHasNotEnded) {
  const RunComparison comparison =
      OnlyOne({AddRun("a", 11, ""), folder_.path() / "none", folder_.path() / "a"});
  EXPECT_EQ(comparison.Tables()[0].rows.size(), 1U);
  EXPECT_THAT(ErrorOf([&] { CompareRuns({folder_.path() / "none"}); }),
              HasSubstr("expected the folder of a run that has ended"));
  EXPECT_THAT(ErrorOf([&] {
                CompareRuns({folder_.path() / "none", folder_.path() / "neither"});
              }),
              HasSubstr("none of the folders"));
}

TEST_F(RunComparisonTest, TellsLongSettingsApart) {
  const std::string same(80, 'x');
  const std::string begin = "schedule { seed: 1 } run { channel_prefix: \"FRESCO\" lcm_url: \"tcpq://" + same;
  const ReportTable table =
      OnlyOne({AddRun("a", 11, begin + "a:7700\" }"), AddRun("b", 12, begin + "b:7700\" }")}).Tables().back();
  ASSERT_EQ(table.rows.size(), 1U);
  EXPECT_EQ(table.rows[0][0], "run.lcm_url");
  EXPECT_LT(table.rows[0][1].size(), 70U);
}

TEST_F(RunComparisonTest, TakesNoFailureIntoAMean) {
  const auto a = AddRun("a", 11, "schedule { seed: 1 }");
  const auto b = AddRun("b", 12, "schedule { seed: 2 }");
  const auto failed = AddRun("failed", 99, "schedule { seed: 3 }");
  const auto interrupted = AddRun("interrupted", 98, "schedule { seed: 4 }");
  const auto without_gap = AddRun("without gap", 13, "schedule { seed: 5 }");
  Change(failed, "success", 0);
  Change(interrupted, "completed", false);
  Change(without_gap, "gap_percent", nullptr);
  EXPECT_THAT(OnlyOne({a, b, failed, interrupted}).Tables()[1].rows,
              ElementsAre(ElementsAre("a, b", "2", HasSubstr("11.500"), HasSubstr("15.000"))));
  EXPECT_THAT(OnlyOne({a, b, without_gap}).Tables()[1].rows,
              ElementsAre(ElementsAre("a, b, without gap", "3", HasSubstr("12.000"), "-")));
}

TEST_F(RunComparisonTest, NamesADamagedFile) {
  const auto run = AddRun("run", 11, "");
  for (const std::string content : {"", "{}", "{\"score\": \"high\"}"}) {
    WriteFileAtomically(run / "summary.json", content);
    EXPECT_THAT(ErrorOf([&] { CompareRuns({run}); }), HasSubstr(run.string()));
  }
  const auto empty = AddRun("empty", 11, "");
  WriteFileAtomically(empty / "metrics.csv", "");
  EXPECT_THAT(ErrorOf([&] { CompareRuns({empty}); }), HasSubstr(empty.string()));
}

TEST_F(RunComparisonTest, ShowsTheSameEpisodeOfEveryPolicy) {
  const std::string fields =
      "scenario { random_sensors { per_episode: true minimum: 1 maximum: 3 } } agent { set_network {} } "
      "schedule { fixed_evaluation_episodes: true seed: ";
  std::vector<std::filesystem::path> runs;
  for (const std::string seed : {"1", "2"}) {
    runs.push_back(AddRun("seed-" + seed, 11, fields + seed + " }"));
    const Experiment experiment = Experiment::Parse(fields + seed + " }", "a test");
    WriteFileAtomically(runs.back() / "best.network",
                        SerializeNetworkFile({experiment, 1, 1, experiment.network()->InitialParameters(1)}));
  }
  const std::vector<ReportEpisode> episodes = OnlyOne(runs).Episodes();
  ASSERT_GE(episodes.size(), 2U);
  for (const ReportEpisode& episode : episodes) {
    EXPECT_EQ(episode.episode.seed, episodes.front().episode.seed) << episode.name;
  }
  WriteFileAtomically(runs.back() / "best.network", "");
  EXPECT_EQ(OnlyOne(runs).Episodes().size(), episodes.size() - 1);
}

}  // namespace
}  // namespace fresco
