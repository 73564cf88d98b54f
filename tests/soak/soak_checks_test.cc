// A soak finds other weights, lost transitions, and growing memory and descriptors.
#include "soak/soak_checks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"

namespace fresco {
namespace {

using testing::HasSubstr;

RunFacts Facts() {
  return {"5e559ba1", "network", 1200, 82800, 20576, 2804};
}

TEST(Differences, AreNoneBetweenEqualRuns) {
  EXPECT_TRUE(Differences(Facts(), Facts()).empty());
}

TEST(Differences, NameTheWeightsOfBothRuns) {
  RunFacts other = Facts();
  other.weights_crc32c = "5e559ba2";
  const auto found = Differences(Facts(), other);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_THAT(found[0], HasSubstr("5e559ba1 undisturbed, 5e559ba2 here"));
}

TEST(Differences, FindANetworkFileWithOtherBytesUnderTheSameSum) {
  RunFacts other = Facts();
  other.final_network = "Network";
  EXPECT_EQ(Differences(Facts(), other).size(), 1u);
}

TEST(Differences, FindEveryCountThatIsAnother) {
  RunFacts other = Facts();
  other.episodes -= 1;
  other.transitions -= 69;
  other.updates += 1;
  other.total_aoi = -1;
  const auto found = Differences(Facts(), other);
  ASSERT_EQ(found.size(), 4u);
  EXPECT_EQ(found[1], "transitions: 82800 undisturbed, 82731 here");
}

UseByProgram Use(int64_t peak_kib, int descriptors) {
  return {{"fresco-learner", {peak_kib, peak_kib, descriptors}}};
}

constexpr int64_t kAllowanceKib = 8 * 1024;

TEST(Excesses, AllowAQuarterAndTheAllowanceAndFourDescriptors) {
  const UseByProgram usual = Use(100 * 1024, 17);
  EXPECT_TRUE(Excesses(usual, Use(133 * 1024, 21), kAllowanceKib).empty());
  EXPECT_TRUE(Excesses(usual, Use(1024, 3), kAllowanceKib).empty());
  EXPECT_TRUE(Excesses(usual, {}, kAllowanceKib).empty());
  const auto memory = Excesses(usual, Use(133 * 1024 + 1, 21), kAllowanceKib);
  ASSERT_EQ(memory.size(), 1u);
  EXPECT_THAT(memory[0], HasSubstr("fresco-learner: peak memory 133 MiB"));
  EXPECT_EQ(Excesses(usual, Use(133 * 1024 + 1, 21), kAllowanceKib + 1).size(), 0u);
  const auto descriptors = Excesses(usual, Use(133 * 1024, 22), kAllowanceKib);
  ASSERT_EQ(descriptors.size(), 1u);
  EXPECT_THAT(descriptors[0], HasSubstr("22 open descriptors"));
}

/// Forty values, uniform over a width of 20. The slope of a least-squares line through them has a standard
/// deviation of 20 / sqrt(12) * sqrt(12 / 40^3); over 39 steps that is a gain of 3.08.
std::vector<double> Noise(uint64_t seed) {
  RandomStream stream(seed, RandomPurpose::kTest, 0, 0);
  std::vector<double> series;
  for (int i = 0; i < 40; ++i) {
    series.push_back(1000 + 20 * (stream.NextUniform() - 0.5));
  }
  return series;
}
constexpr double kNoiseDeviation = 3.08;

/// The root mean square of what growth differs from `trend`, over many noisy series with that trend.
double Error(double trend) {
  constexpr uint64_t kSeries = 500;
  double sum = 0;
  for (uint64_t seed = 0; seed < kSeries; ++seed) {
    std::vector<double> series = Noise(seed);
    for (size_t i = 0; i < series.size(); ++i) {
      series[i] += trend * static_cast<double>(i) / static_cast<double>(series.size() - 1);
    }
    const double error = Growth(series) - trend;
    sum += error * error;
  }
  return std::sqrt(sum / kSeries);
}

TEST(Growth, OfASteadySeriesIsItsWholeGain) {
  EXPECT_DOUBLE_EQ(Growth({1, 3, 5, 7, 9}), 8);
  EXPECT_DOUBLE_EQ(Growth({9, 7, 5, 3, 1}), -8);
}

TEST(Growth, OfANoisySeriesIsAsCertainAsALeastSquaresLine) {
  EXPECT_NEAR(Error(0) / kNoiseDeviation, 1, 0.2);   // flat
  EXPECT_NEAR(Error(39) / kNoiseDeviation, 1, 0.2);  // growing
}

TEST(Growth, IsNotASingleStepOrPeak) {
  EXPECT_DOUBLE_EQ(Growth({5, 9, 9, 9, 9, 9, 9, 9}), 0);
  EXPECT_DOUBLE_EQ(Growth({5, 5, 5, 90, 5, 5, 5}), 0);
}

TEST(Growth, AsksForFourValues) {
  EXPECT_DOUBLE_EQ(Growth({1, 100, 10000}), 0);
  EXPECT_DOUBLE_EQ(Growth({}), 0);
}

std::vector<ProcessUse> AfterRounds(int64_t more_kib, int more_descriptors) {
  std::vector<ProcessUse> uses;
  for (int round = 0; round < 10; ++round) {
    uses.push_back({10'000 + round * more_kib, 0, 13 + round * more_descriptors});
  }
  return uses;
}

TEST(Leaks, AreFoundInMemoryAndDescriptors) {
  EXPECT_TRUE(Leaks(AfterRounds(0, 0), kAllowanceKib).empty());
  EXPECT_TRUE(Leaks(AfterRounds(900, 0), kAllowanceKib).empty());
  ASSERT_EQ(Leaks(AfterRounds(3000, 0), kAllowanceKib).size(), 1u);
  EXPECT_THAT(Leaks(AfterRounds(3000, 0), kAllowanceKib)[0], HasSubstr("memory grew by 26 MiB"));
  EXPECT_TRUE(Leaks(AfterRounds(3000, 0), 4 * kAllowanceKib).empty());
  ASSERT_EQ(Leaks(AfterRounds(0, 1), kAllowanceKib).size(), 1u);
  EXPECT_THAT(Leaks(AfterRounds(0, 1), kAllowanceKib)[0], HasSubstr("descriptors grew by 9"));
}

}  // namespace
}  // namespace fresco
