// What a person reads while a run is going and when it is over.
#include "tools/train_display.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace fresco {
namespace {

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
  status.average_aoi = status.best_average_aoi = status.lower_bound_average_aoi = status.gap_percent = kNan;
  return status;
}

std::string Summary(const std::string& average_aoi, const std::string& optimum) {
  return R"({"average_aoi": )" + average_aoi + R"(, "total_aoi": 2804, "arrived": true, )" + optimum +
         R"(, "baselines": {"aoi": {"average_aoi": 17.5, "total_aoi": 3684, "arrived": true},
             "distance": {"average_aoi": 17.0, "total_aoi": 3589, "arrived": false}}})";
}

constexpr char kProved[] =
    R"("optimal_average_aoi": 12.5, "optimal_total_aoi": 2625, "lower_bound_average_aoi": 12.5)";
constexpr char kBounded[] =
    R"("optimal_average_aoi": null, "optimal_total_aoi": null, "lower_bound_average_aoi": 10)";
constexpr char kUnknown[] =
    R"("optimal_average_aoi": null, "optimal_total_aoi": null, "lower_bound_average_aoi": null)";

TEST(ProgressLine, SaysHowFarTheRunIsAndWhoWaits) {
  learner_status_t status = Status();
  EXPECT_EQ(
      ProgressLine(status),
      " 25% | 1500 of 6000 episodes | 12000 updates | epsilon 0.160 | greedy AoI - | 4800 transitions/s | "
      "600 updates/s | 2 actors | actors wait for the learner");
  status.waiting_for = "an actor to join";
  EXPECT_NE(ProgressLine(status).find("learner waits for an actor to join"), std::string::npos);
}

TEST(ProgressLine, BeginsWithAWarning) {
  learner_status_t status = Status();
  status.warning = "the last checkpoint could not be written";
  EXPECT_EQ(ProgressLine(status).find("WARNING: the last checkpoint could not be written |  25% | 1500 of"),
            0u);
}

TEST(ProgressLine, ShowsTheGapOnceThereIsABound) {
  learner_status_t status = Status();
  status.average_aoi = 14;
  status.best_average_aoi = 13.75;
  status.arrived = 1;
  EXPECT_NE(ProgressLine(status).find("greedy AoI 14.000 |"), std::string::npos);
  status.gap_percent = 10;
  EXPECT_NE(ProgressLine(status).find("best 13.750 (at most 10.00 % over the optimum)"), std::string::npos);
  status.optimum_proved = 1;
  EXPECT_NE(ProgressLine(status).find("best 13.750 (10.00 % over the optimum)"), std::string::npos);
  status.arrived = 0;
  EXPECT_NE(ProgressLine(status).find("14.000 (not arrived)"), std::string::npos);
}

TEST(PolicyRows, HoldEveryPolicyAgainstTheOptimum) {
  const auto rows = PolicyRows(Summary("13", kProved));
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_EQ(rows[0][3], "gap");
  EXPECT_EQ(rows[1], (std::vector<std::string>{"this run (DQN)", "13.000", "2804", "4.00 %", "yes"}));
  EXPECT_EQ(rows[2][3], "40.00 %");
  EXPECT_EQ(rows[3], (std::vector<std::string>{"distance-based", "17.000", "3589", "-", "NO"}));
  EXPECT_EQ(rows[4], (std::vector<std::string>{"exact optimum", "12.500", "2625", "0.00 %", "yes"}));
}

TEST(PolicyRows, SayThatAGapToABoundIsOneAtMost) {
  const auto rows = PolicyRows(Summary("13", kBounded));
  EXPECT_EQ(rows[0][3], "gap at most");
  EXPECT_EQ(rows[1][3], "30.00 %");
  EXPECT_EQ(rows[4][0], "lower bound");
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
  EXPECT_NE(table.find("exact optimum"), std::string::npos);
}

}  // namespace
}  // namespace fresco
