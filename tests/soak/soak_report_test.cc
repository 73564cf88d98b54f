// A soak's verdict, and what it says if a round failed.
#include "soak/soak_report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace fresco {
namespace {

RoundResult Complete(const std::string& crc) {
  RoundResult result;
  result.facts = RunFacts{crc, "", 10, 100, 20, 2800};
  return result;
}

SoakReport Report() {
  SoakReport report;
  report.undisturbed = Complete("00000001");
  report.rounds.push_back({1, "drop=0.01", Complete("00000001"), "tools/fresco soak --first-round 1"});
  return report;
}

TEST(SoakReport, PassesWhereEveryRoundIsEqual) {
  EXPECT_TRUE(Report().passed());
  EXPECT_EQ(nlohmann::json::parse(SoakJson(Report())).at("verdict"), "equal");
}

TEST(SoakReport, DoesNotPassWithoutARoundThatWasCompared) {
  SoakReport none = Report();
  none.rounds.clear();
  EXPECT_FALSE(none.passed());
  SoakReport incomplete = Report();
  incomplete.rounds[0].result.facts.reset();
  EXPECT_FALSE(incomplete.passed());
  SoakReport interrupted = Report();
  interrupted.interrupted = true;
  EXPECT_FALSE(interrupted.passed());
  EXPECT_EQ(nlohmann::json::parse(SoakJson(interrupted)).at("verdict"), "interrupted");
}

TEST(SoakReport, NamesWhatDifferedAndHowToHaveItAgain) {
  SoakReport report = Report();
  report.rounds[0].result.failures = {"other weights"};
  EXPECT_FALSE(report.passed());
  const std::string text = SoakText(report);
  EXPECT_NE(text.find("verdict: failed"), std::string::npos);
  EXPECT_NE(text.find("round 1: other weights"), std::string::npos);
  EXPECT_NE(text.find("again: tools/fresco soak --first-round 1"), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(SoakJson(report)).at("verdict"), "failed");
}

TEST(SoakReport, GivesTheMeanAndLongestRecoveryByKind) {
  SoakReport report = Report();
  Fault kill;
  kill.kind = FaultKind::kKillLearner;
  report.rounds[0].result.faults = {{kill, 0, 0, 1.0}, {kill, 0, 0, 2.0}, {kill, 0, 0, {}}};
  const auto figures = nlohmann::json::parse(SoakJson(report)).at("faults").at("kill_learner");
  EXPECT_EQ(figures.at("number"), 3);
  EXPECT_EQ(figures.at("recovered"), 2);
  EXPECT_DOUBLE_EQ(figures.at("mean_recovery_s"), 1.5);
  EXPECT_DOUBLE_EQ(figures.at("longest_recovery_s"), 2);
  ASSERT_EQ(FaultRows(report).size(), 3u);
  EXPECT_EQ(FaultRows(report)[0].size(), FaultHeader().size());
}

}  // namespace
}  // namespace fresco
