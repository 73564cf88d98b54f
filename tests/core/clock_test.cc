#include "core/clock.h"

#include <gtest/gtest.h>

#include <thread>

namespace fresco {
namespace {

TEST(AttentiveClock, GoesWithTheOtherWhileItIsLookedAt) {
  AttentiveClock clock;
  const int64_t begin_us = clock.Look(5'000'000);
  EXPECT_GT(begin_us, 0);
  EXPECT_EQ(clock.Look(5'002'000), begin_us + 2'000);
  EXPECT_EQ(clock.Look(5'102'000), begin_us + 102'000);
  EXPECT_EQ(clock.now_us(), begin_us + 102'000);
}

TEST(AttentiveClock, DoesNotCountTheTimeInWhichNobodyLooked) {
  AttentiveClock clock;
  const int64_t begin_us = clock.Look(0);
  EXPECT_EQ(clock.Look(60'000'000), begin_us + AttentiveClock::kLongestGapUs);
  EXPECT_EQ(clock.Look(60'001'000), begin_us + AttentiveClock::kLongestGapUs + 1'000);
}

TEST(AttentiveClock, NeverGoesBack) {
  AttentiveClock clock;
  const int64_t begin_us = clock.Look(1'000);
  EXPECT_EQ(clock.Look(500), begin_us);
  EXPECT_EQ(clock.Look(600), begin_us + 100);
}

TEST(ProcessorTime, OfTheProcessIncludesThatOfItsThreads) {
  const int64_t process_us = ProcessProcessorMicroseconds();
  int64_t thread_us = 0;
  std::thread([&] {
    while (thread_us < 2'000) {
      thread_us = ThreadProcessorMicroseconds();
    }
  }).join();
  EXPECT_GE(ProcessProcessorMicroseconds() - process_us, 2'000);
}

TEST(RateMeter, TellsTheRateOfTheLastTimeOfAtLeastASecond) {
  RateMeter meter;
  EXPECT_EQ(meter.Measure(0, 0), 0);
  EXPECT_EQ(meter.Measure(900, 999'999), 0);
  EXPECT_EQ(meter.Measure(1000, 2'000'000), 500);
  EXPECT_EQ(meter.Measure(5000, 2'999'999), 500);
  EXPECT_EQ(meter.Measure(1030, 3'000'000), 30);
}

}  // namespace
}  // namespace fresco
