// What people read during a run and at its end.
#include "report/result_display.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "tests/worlds/test_scenarios.h"
#include "worlds/cartpole/cartpole.h"
#include "worlds/uav/uav_world.h"

namespace fresco {
namespace {

using testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

learner_status_t Status() {
  learner_status_t status{};
  status.episodes = 1500;
  status.total_episodes = 6000;
  status.updates = 12000;
  status.epsilon = 0.16;
  status.transitions_per_s = 4800;
  status.updates_per_s = 600;
  status.actors = 2;
  status.score = status.best_score = status.score_bound = status.gap_percent = kNan;
  return status;
}

std::string UavLine(const learner_status_t& status) {
  static const UavWorld world(TableOneScenario());
  return ProgressLine(status, world.description());
}

std::string CartPoleLine(const learner_status_t& status) {
  return ProgressLine(status, CartPole(500).description());
}

/// The gap of an average AoI to the optimum of kProved.
std::string GapText(const std::string& average_aoi, const std::string& optimum) {
  const bool proved = optimum.find("\"proved\"") != std::string::npos;
  return average_aoi != "null" && proved ? std::to_string((std::stod(average_aoi) / 12.5 - 1) * 100) : "null";
}

std::string Summary(const std::string& average_aoi, const std::string& optimum) {
  const std::string success = average_aoi == "null" ? "null" : "1";
  const std::string arrived = average_aoi == "null" ? "null" : "true";
  return R"({"world": {"name": "uav", "success": "arrived", "figures": [{"name": "average_aoi", "unit": "slots"},
             {"name": "total_aoi", "unit": "slots"}, {"name": "sum_aoi", "unit": "slots"}]},
             "score": )" +
         average_aoi + R"(, "success": )" + success + R"(, "average_aoi": )" + average_aoi +
         R"(, "total_aoi": 2804, "sum_aoi": 40.057, "arrived": )" + arrived + R"(, "gap_percent": )" +
         GapText(average_aoi, optimum) + ", " + optimum +
         R"(, "baselines": {"aoi": {"title": "AoI-based", "average_aoi": 17.5, "total_aoi": 3684,
                                    "sum_aoi": 52.6, "arrived": true, "gap_percent": )" +
         GapText("17.5", optimum) + R"(},
             "distance": {"title": "distance-based", "average_aoi": 17.0, "total_aoi": 3589, "sum_aoi": 51.3,
                          "arrived": false}}})";
}

/// Of four judged episodes in two groups; `unproved` is what one of them has for its optimum.
std::string SummaryOfFields(const std::string& optimum_of_last, const std::string& gap_of_last) {
  return R"({"world": {"name": "uav", "success": "arrived", "figures": [{"name": "average_aoi", "unit": "slots"}]},
             "score": 11.75, "success": 1, "average_aoi": 11.75, "arrived": true, "gap_percent": null,
             "optimal_average_aoi": null, "best_found_average_aoi": 9, "lower_bound_average_aoi": 9,
             "optimum_search": "limit", "judged_episodes": [
    {"seed": 1, "group": "10 sensors", "average_aoi": 12, "optimal_average_aoi": 10, "gap_percent": 20,
     "baselines": {"aoi": 13, "distance": 14}},
    {"seed": 2, "group": "2 sensors", "average_aoi": 11, "optimal_average_aoi": 10, "gap_percent": 10,
     "baselines": {"aoi": 13, "distance": 12}},
    {"seed": 3, "group": "2 sensors", "average_aoi": 10, "optimal_average_aoi": 10, "gap_percent": 0,
     "baselines": {"aoi": 14, "distance": 15}},
    {"seed": 4, "group": "2 sensors", "average_aoi": 14, "optimal_average_aoi": )" +
         optimum_of_last + R"(, "gap_percent": )" + gap_of_last + R"(,
     "baselines": {"aoi": 11, "distance": 15}}]})";
}

/// Of a world with chance, without baselines and without a search for the optimum.
std::string CartPoleSummary(const std::string& score, const std::string& success) {
  const std::string all = success == "null" ? "null" : success == "1" ? "true" : "false";
  return R"({"world": {"name": "cartpole", "success": "balanced", "figures": [{"name": "return", "unit": ""}]},
             "score": )" +
         score + R"(, "success": )" + success + R"(, "return": )" + score + R"(, "balanced": )" + all + "}";
}

constexpr char kProved[] =
    R"("optimum_search": "proved", "optimal_average_aoi": 12.5, "optimal_total_aoi": 2625,
       "best_found_average_aoi": 12.5, "best_found_total_aoi": 2625, "lower_bound_average_aoi": 12.5)";
constexpr char kBounded[] =
    R"("optimum_search": "limit", "optimal_average_aoi": null, "optimal_total_aoi": null,
       "best_found_average_aoi": 12.75, "best_found_total_aoi": 2680, "lower_bound_average_aoi": 10)";
constexpr char kUnknown[] =
    R"("optimum_search": "off", "optimal_average_aoi": null, "optimal_total_aoi": null,
       "best_found_average_aoi": null, "best_found_total_aoi": null, "lower_bound_average_aoi": null)";

TEST(ProgressLine, SaysHowFarTheRunIsAndWhoWaits) {
  learner_status_t status = Status();
  EXPECT_EQ(UavLine(status),
            " 25% | 1500 of 6000 episodes | 12000 updates | epsilon 0.160 | greedy average AoI - | 4800 "
            "transitions/s | "
            "600 updates/s | 2 actors | actors wait for the learner");
  status.waiting_for = "an actor to join";
  EXPECT_THAT(UavLine(status), HasSubstr("learner waits for an actor to join"));
}

TEST(ProgressLine, BeginsWithWhatIsWaitedForAfterTheTraining) {
  learner_status_t status = Status();
  status.episodes = status.total_episodes;
  status.waiting_for = "the proof of the exact optimum: at most 40 s more of processor time";
  EXPECT_EQ(
      UavLine(status).find(
          "trained, waits for the proof of the exact optimum: at most 40 s more of processor time | 6000 "),
      0u);
}

TEST(ProgressLine, BeginsWithAWarning) {
  learner_status_t status = Status();
  status.warning = "the last checkpoint could not be written";
  EXPECT_EQ(UavLine(status).find("WARNING: the last checkpoint could not be written |  25% | 1500 of"), 0u);
}

TEST(ProgressLine, ShowsTheGapOnceTheOptimumIsProvedAndABoundBefore) {
  learner_status_t status = Status();
  status.score = 14;
  status.best_score = 13.75;
  status.success = 1;
  EXPECT_THAT(UavLine(status), HasSubstr("greedy average AoI 14.000 |"));
  status.score_bound = 1.25;
  EXPECT_THAT(UavLine(status), HasSubstr("best 13.750 (optimum not proved, at least 1.250) |"));
  status.score_bound = 12.5;
  status.gap_percent = 10;
  status.optimum_proved = 1;
  EXPECT_THAT(UavLine(status), HasSubstr("best 13.750 (10.00 % over the optimum)"));
  status.success = 0;
  EXPECT_THAT(UavLine(status), HasSubstr("14.000 (not arrived)"));
}

TEST(ProgressLine, ShowsTheShareOfSuccessInAWorldWithChance) {
  learner_status_t status = Status();
  EXPECT_THAT(CartPoleLine(status), HasSubstr("| greedy return - |"));
  status.score = 21.5;
  EXPECT_THAT(CartPoleLine(status), HasSubstr("| greedy return 21.500 (not balanced) |"));
  status.best_score = 480.25;
  status.success = 0.4;
  EXPECT_THAT(CartPoleLine(status), HasSubstr("| greedy return 21.500 (40 % balanced), best 480.250 |"));
  status.success = 0.998;
  EXPECT_THAT(CartPoleLine(status), HasSubstr("(99.8 % balanced)"));
  status.score = 500;
  status.success = 1;
  EXPECT_THAT(CartPoleLine(status), HasSubstr("| greedy return 500.000, best 480.250 |"));
}

TEST(PercentText, IsNeverAllOrNothingWithoutBeingIt) {
  EXPECT_EQ(PercentText(0), "0 %");
  EXPECT_EQ(PercentText(1), "100 %");
  EXPECT_EQ(PercentText(0.37), "37 %");
  EXPECT_EQ(PercentText(2.0 / 3), "67 %");
  EXPECT_EQ(PercentText(0.999), "99.9 %");
  EXPECT_EQ(PercentText(0.001), "0.1 %");
  EXPECT_EQ(PercentText(0.996), "99.6 %");
  EXPECT_EQ(PercentText(1 - 1e-6), "99.9999 %");
}

/// An account with a value of every type.
EpisodeAccount SmallAccount() {
  EpisodeAccount account;
  account.facts = {{"won", true}, {"steps", int64_t{1}}, {"score", 0.1}, {"how", "slowly"}};
  account.steps_name = "moves";
  account.columns = {"step", "height_m", "action", "ages", "reward"};
  account.steps = {{int64_t{0}, 2.5, "up", std::vector<int64_t>{1, 20}, -3.0},
                   {int64_t{10}, 1.0 / 3, {}, std::vector<int64_t>{}, {}}};
  return account;
}

TEST(EpisodeJson, HasTheFactsAndStepsOfTheAccountInTheirOrder) {
  EXPECT_EQ(nlohmann::ordered_json::parse(EpisodeJson(SmallAccount(), "p")).dump(),
            R"({"policy":"p","won":true,"steps":1,"score":0.1,"how":"slowly","moves":[)"
            R"({"step":0,"height_m":2.5,"action":"up","ages":[1,20],"reward":-3.0},)"
            R"({"step":10,"height_m":0.3333333333333333,"action":null,"ages":[],"reward":null}]})");
}

TEST(EpisodeJson, HasTheBoundsOfAPlan) {
  Plan plan;
  plan.optimal = true;
  plan.lower_bound_total_aoi = 3;
  const auto json = nlohmann::json::parse(EpisodeJson(SmallAccount(), "optimal", plan));
  EXPECT_EQ(json["optimal"], true);
  EXPECT_EQ(json["lower_bound_total_aoi"], 3);
  EXPECT_TRUE(json.contains("lower_bound_average_aoi"));
}

TEST(StepTable, HasNumbersAtTheRight) {
  EXPECT_EQ(StepTable(SmallAccount()),
            "step  height_m  action  ages  reward\n"
            "   0       2.5  up      1 20      -3\n"
            "  10  0.333333  -                  -\n");
}

using Rows = std::vector<std::vector<std::string>>;

TEST(CartPoleRows, HaveNeitherGapNorBaselinesNorOptimum) {
  EXPECT_EQ(PolicyRows(CartPoleSummary("487.25", "0.9")),
            (Rows{{"policy", "return", "balanced"}, {"this run (DQN)", "487.250", "90 %"}}));
  EXPECT_EQ(PolicyRows(CartPoleSummary("500", "1")).at(1),
            (std::vector<std::string>{"this run (DQN)", "500.000", "yes"}));
  EXPECT_EQ(PolicyRows(CartPoleSummary("9.5", "0")).at(1),
            (std::vector<std::string>{"this run (DQN)", "9.500", "NO"}));
  EXPECT_EQ(PolicyRows(CartPoleSummary("null", "null")).at(1),
            (std::vector<std::string>{"this run (DQN)", "-", "not evaluated"}));
  EXPECT_EQ(OptimumNote(CartPoleSummary("500", "1")), "");
}

TEST(CartPoleRows, AreATableOfTwoLines) {
  EXPECT_EQ(ResultTable(CartPoleSummary("487.25", "0.9")),
            "  policy                return  balanced\n"
            "  this run (DQN)       487.250  90 %\n");
}

TEST(PolicyRows, HoldEveryPolicyAgainstTheOptimum) {
  const auto rows = PolicyRows(Summary("13", kProved));
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_EQ(rows[0], (std::vector<std::string>{"policy", "average AoI", "total AoI", "gap", "arrived"}));
  EXPECT_EQ(rows[1], (std::vector<std::string>{"this run (DQN)", "13.000", "2804", "4.00 %", "yes"}));
  EXPECT_EQ(rows[2][3], "40.00 %");
  EXPECT_EQ(rows[3], (std::vector<std::string>{"distance-based", "17.000", "3589", "-", "NO"}));
  EXPECT_EQ(rows[4], (std::vector<std::string>{"exact optimum", "12.500", "2625", "0.00 %", "yes"}));
}

TEST(PolicyRows, HaveNoGapAndNoOptimumIfThatIsNotProved) {
  const auto rows = PolicyRows(Summary("13", kBounded));
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_EQ(rows[0][3], "gap");
  EXPECT_EQ(rows[1], (std::vector<std::string>{"this run (DQN)", "13.000", "2804", "not proved", "yes"}));
  EXPECT_EQ(rows[2][3], "not proved");
  EXPECT_EQ(rows[4],
            (std::vector<std::string>{"best flight of the search", "12.750", "2680", "not proved", "yes"}));
}

TEST(OptimumNote, SaysInWordsWhatABoundIsAndWhyThereIsNoMore) {
  EXPECT_EQ(OptimumNote(Summary("13", kBounded)),
            "The exact optimum is not proved: the search reached run.optimum_limit_s or "
            "run.optimum_memory_mb. No flight has an average AoI below 10.000; this run lies above the "
            "optimum by at most 30.00 %, which is a bound and not the gap.");
  std::string stopped = Summary("13", kBounded);
  stopped.replace(stopped.find("limit"), 5, "stopped");
  EXPECT_THAT(OptimumNote(stopped), HasSubstr("the search was stopped."));
  EXPECT_EQ(OptimumNote(Summary("13", kProved)), "");
  EXPECT_EQ(OptimumNote(Summary("null", kUnknown)), "");
  std::string failed = Summary("null", kUnknown);
  failed.replace(failed.find("off"), 3, "failed");
  EXPECT_THAT(OptimumNote(failed), HasSubstr("failed"));
}

TEST(PolicyRows, LeaveOutWhatIsNotKnown) {
  const auto rows = PolicyRows(Summary("null", kUnknown));
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[1][4], "not evaluated");
  EXPECT_EQ(rows[2][3], "-");
}

TEST(ResultTable, HasALineForEveryRow) {
  const std::string table = ResultTable(Summary("13", kProved));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 5);
  EXPECT_THAT(table, HasSubstr("exact optimum"));
  const std::string unproved = ResultTable(Summary("13", kBounded));
  EXPECT_EQ(std::count(unproved.begin(), unproved.end(), '\n'), 6);
  EXPECT_EQ(unproved.find("exact optimum  "), std::string::npos);
  EXPECT_THAT(unproved, HasSubstr("The exact optimum is not proved"));
}

TEST(GapRows, HaveTheGapsOfEveryGroupAndOfAll) {
  EXPECT_EQ(GapRows(SummaryOfFields("10", "40")),
            (Rows{{"episodes with", "number", "gap", "median", "worst", "better baseline"},
                  {"2 sensors", "3", "16.67 %", "10.00 %", "40.00 %", "23.33 %"},
                  {"10 sensors", "1", "20.00 %", "20.00 %", "20.00 %", "30.00 %"},
                  {"all", "4", "17.50 %", "15.00 %", "40.00 %", "25.00 %"}}));
}

TEST(GapRows, LeaveOutEpisodesWithoutAProof) {
  const auto rows = GapRows(SummaryOfFields("null", "null"));
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[1], (std::vector<std::string>{"2 sensors", "2", "5.00 %", "5.00 %", "10.00 %", "30.00 %"}));
  EXPECT_THAT(OptimumNote(SummaryOfFields("null", "null")),
              testing::HasSubstr("The exact optimum of 1 episodes is not proved"));
}

TEST(GapRows, AreNoneWithoutJudgedEpisodes) {
  EXPECT_TRUE(GapRows(Summary("14", kProved)).empty());
  EXPECT_TRUE(GapRows(CartPoleSummary("300", "0")).empty());
}

}  // namespace
}  // namespace fresco
