#include "core/error.h"

#include <gtest/gtest.h>

namespace fresco {
namespace {

const std::vector<std::string> kCommands = {"train", "evaluate",   "retrain",
                                            "log",   "log record", "log export"};

TEST(EditDistance, CountsInsertionsRemovalsReplacementsAndSwapsOfNeighbours) {
  EXPECT_EQ(EditDistance("", ""), 0u);
  EXPECT_EQ(EditDistance("", "abc"), 3u);
  EXPECT_EQ(EditDistance("abc", ""), 3u);
  EXPECT_EQ(EditDistance("train", "train"), 0u);
  EXPECT_EQ(EditDistance("trian", "train"), 1u);     // a swap
  EXPECT_EQ(EditDistance("confg", "config"), 1u);    // an insertion
  EXPECT_EQ(EditDistance("kitten", "sitting"), 3u);  // Levenshtein's own example
  EXPECT_EQ(EditDistance("ca", "abc"), 3u);          // 2 only if a swapped pair could be edited again
  EXPECT_EQ(EditDistance("sunday", "saturday"), 3u);
}

TEST(NearestName, IsTheOneThatTakesTheFewestEdits) {
  EXPECT_EQ(NearestName("trian", kCommands), "train");
  EXPECT_EQ(NearestName("retrian", kCommands), "retrain");
  EXPECT_EQ(NearestName("evalaute", kCommands), "evaluate");
  EXPECT_EQ(NearestName("bx", {"by"}), std::nullopt);        // a half of it
  EXPECT_EQ(NearestName("batt", {"bats", "bath"}), "bats");  // the first of equals
}

TEST(NearestName, MayBeginOrEndWithWhatWasGiven) {
  EXPECT_EQ(NearestName("eval", kCommands), "evaluate");
  EXPECT_EQ(NearestName("record", kCommands), "log record");
  EXPECT_EQ(NearestName("seed", {"scenario.random_sensors.seed", "schedule.seed"}), "schedule.seed");
  EXPECT_EQ(NearestName("ev", kCommands), std::nullopt);
}

TEST(NearestName, IsNoneWhereNothingIsNear) {
  EXPECT_EQ(NearestName("frobnicate", kCommands), std::nullopt);
  EXPECT_EQ(NearestName("", kCommands), std::nullopt);
  EXPECT_EQ(NearestName("train", {}), std::nullopt);
  EXPECT_EQ(NearestName(std::string(10'000'000, 'x'), kCommands), std::nullopt);  // no table of that size
}

TEST(DidYouMean, IsTheEndOfAnErrorsText) {
  EXPECT_EQ(DidYouMean("trian", kCommands), "; did you mean train?");
  EXPECT_EQ(DidYouMean("frobnicate", kCommands), "");
}

}  // namespace
}  // namespace fresco
