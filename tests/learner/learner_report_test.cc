#include "learner/learner_report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace fresco {
namespace {

Evaluation EvaluationOf(double score, double success) {
  Evaluation evaluation;
  evaluation.success = success;
  evaluation.figures = {score, 1e9};
  return evaluation;
}

TEST(TrainingReport, TellsNoScoreBeforeThereIsOne) {
  learner_status_t status{};
  TrainingReport{}.WriteTo(status);
  EXPECT_TRUE(std::isnan(status.score));
  EXPECT_EQ(status.success, 0);
  for (const double value : {status.best_score, status.score_bound, status.gap_percent}) {
    EXPECT_TRUE(std::isnan(value));
  }
}

TEST(TrainingReport, TellsTheBestScoreOnceAnEpisodeHasSucceeded) {
  learner_status_t status{};
  const Evaluation failed = EvaluationOf(17, 0);
  TrainingReport{.last_evaluation = failed, .best = BestNetwork{failed, nullptr}}.WriteTo(status);
  EXPECT_EQ(status.score, 17);
  EXPECT_EQ(status.success, 0);
  EXPECT_TRUE(std::isnan(status.best_score));
  const Evaluation best = EvaluationOf(250, 0.25);
  TrainingReport{.last_evaluation = failed, .best = BestNetwork{best, nullptr}}.WriteTo(status);
  EXPECT_EQ(status.score, 17);
  EXPECT_EQ(status.best_score, 250);
  TrainingReport{.last_evaluation = best, .best = BestNetwork{best, nullptr}}.WriteTo(status);
  EXPECT_EQ(status.success, 0.25);
}

TEST(StarvationWarning, SpeaksAfterFiveSecondsAndThenEveryTen) {
  StarvationWarning warning;
  std::vector<std::pair<int, std::string>> lines;
  for (int tenths = 0; tenths <= 300; ++tenths) {
    if (const auto line = warning.Note(tenths / 10.0, "an actor to join")) {
      lines.emplace_back(tenths, *line);
    }
  }
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0], std::pair(51, std::string("no result for 5 s: waiting for an actor to join")));
  EXPECT_EQ(lines[1].first, 152);
  EXPECT_EQ(lines[2].first, 253);
}

TEST(StarvationWarning, SaysWhenTheRunGoesOn) {
  StarvationWarning warning;
  EXPECT_TRUE(warning.Note(6, "an actor to join"));
  EXPECT_FALSE(warning.Note(12, "an actor to join"));
  EXPECT_EQ(warning.Note(0, ""), "a result arrived after 12 s; the run continues");
  EXPECT_FALSE(warning.Note(0, ""));
  EXPECT_TRUE(warning.Note(5.5, "an actor to join"));
}

TEST(StarvationWarning, KeepsQuietAboutShortWaits) {
  StarvationWarning warning;
  for (int wait = 0; wait < 100; ++wait) {
    EXPECT_FALSE(warning.Note(4.9, "an actor to join"));
    EXPECT_FALSE(warning.Note(0, ""));
  }
}

}  // namespace
}  // namespace fresco
