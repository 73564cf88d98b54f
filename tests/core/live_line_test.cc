#include "core/live_line.h"

#include <gtest/gtest.h>

namespace fresco {
namespace {

constexpr int64_t kSecondUs = 1'000'000;

TEST(TimeLeft, GoesOnAsFastAsSinceTheFirstReport) {
  TimeLeft time_left;
  EXPECT_EQ(time_left.Report(100, 400, 5 * kSecondUs), "");
  EXPECT_EQ(time_left.Report(200, 400, 25 * kSecondUs), "about 40 s left");
  EXPECT_EQ(time_left.Report(300, 400, 65 * kSecondUs), "about 30 s left");
  EXPECT_EQ(time_left.Report(400, 400, 85 * kSecondUs), "");
}

TEST(TimeLeft, IsInMinutesIfItIsLong) {
  TimeLeft time_left;
  time_left.Report(0, 100, 0);
  EXPECT_EQ(time_left.Report(1, 100, 60 * kSecondUs), "about 99 min left");
}

TEST(TimeLeft, SaysNothingThatItCannotKnow) {
  TimeLeft time_left;
  EXPECT_EQ(time_left.Report(0, 0, 0), "");
  EXPECT_EQ(time_left.Report(0, 0, 9 * kSecondUs), "");
  EXPECT_EQ(time_left.Report(5, 10, 9 * kSecondUs), "about 9 s left");
  EXPECT_EQ(time_left.Report(-3, 10, 19 * kSecondUs), "");
}

}  // namespace
}  // namespace fresco
