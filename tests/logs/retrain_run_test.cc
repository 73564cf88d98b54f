// What a retraining says about its logs and its result.
#include "logs/retrain_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace fresco {
namespace {

using testing::HasSubstr;
using testing::Not;

RetrainReport Report() {
  RetrainReport report;
  report.logs = {"a.lcm", "b.lcm"};
  report.run.identity = {0x1f, 0xabcd};
  report.counts.recorded_episodes = 90;
  report.counts.flown_again = 10;
  report.counts.compared_versions = 7;
  return report;
}

TEST(RetrainReport, NamesOrdersAsRanges) {
  EXPECT_EQ(RangesText({{3, 3}}), "3 (1 order in all)");
  EXPECT_EQ(RangesText({{3, 3}, {17, 20}}), "3, 17 to 20 (5 orders in all)");
  std::vector<Interval> many;
  for (int64_t i = 0; i < 100; ++i) {
    many.push_back({2 * i, 2 * i});
  }
  EXPECT_THAT(RangesText(many), HasSubstr(", 22 and 88 more ranges (100 orders in all)"));
}

TEST(RetrainReport, SaysWhetherItIsTheRecordedRun) {
  RetrainReport report = Report();
  EXPECT_THAT(EndText(report), HasSubstr("90 episodes from the log, 10 flown again"));
  EXPECT_THAT(EndText(report), HasSubstr("all 7 versions"));
  report.counts.different_versions = 2;
  report.counts.first_different_version = 5;
  EXPECT_THAT(EndText(report), HasSubstr("NOT the recorded run"));
  EXPECT_THAT(EndText(report), HasSubstr("from version 5 on"));
}

TEST(RetrainReport, SaysPlainlyThatAnotherAgentWasTrained) {
  RetrainReport report = Report();
  report.use = Retraining::Use::kExperience;
  EXPECT_THAT(BeginText(report), HasSubstr("not the recorded run"));
  EXPECT_THAT(EndText(report), HasSubstr("another agent, trained offline"));
}

TEST(RetrainReport, SaysWhatIsWrongWithTheLog) {
  RetrainReport report = Report();
  EXPECT_THAT(BeginText(report), Not(HasSubstr("cut")));
  EXPECT_THAT(BeginText(report), Not(HasSubstr("misses")));
  report.totals = {1000, 20, 30};
  report.missing = {{4, 5}};
  EXPECT_THAT(BeginText(report), HasSubstr("cut short: its last event (30 bytes)"));
  EXPECT_THAT(BeginText(report), HasSubstr("20 bytes of the log are damaged"));
  EXPECT_THAT(BeginText(report), HasSubstr("misses the episodes of orders 4 to 5 (2 orders in all)"));
}

TEST(RetrainReport, StandsInTheSummary) {
  const auto json = nlohmann::json::parse(WithRetrainReport(R"({"weights_crc32c": "01234567"})", Report()));
  EXPECT_EQ(json.at("weights_crc32c"), "01234567");
  const auto& retrain = json.at("retrain");
  EXPECT_EQ(retrain.at("logs"), nlohmann::json({"a.lcm", "b.lcm"}));
  EXPECT_EQ(retrain.at("recorded_run_id"), "000000000000001f");
  EXPECT_EQ(retrain.at("recorded_config_hash"), "0000abcd");
  EXPECT_EQ(retrain.at("same_configuration"), true);
  EXPECT_EQ(retrain.at("flown_again"), 10);
}

}  // namespace
}  // namespace fresco
