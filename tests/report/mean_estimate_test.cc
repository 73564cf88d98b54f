#include "report/mean_estimate.h"

#include <gtest/gtest.h>

#include <vector>

namespace fresco {
namespace {

TEST(MeanEstimate, HasTheQuantilesOfThePublishedTables) {
  // NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.6.7.2, with more digits.
  EXPECT_NEAR(StudentQuantile(0.975, 1), 12.706205, 5e-7);
  EXPECT_NEAR(StudentQuantile(0.975, 2), 4.302653, 5e-7);
  EXPECT_NEAR(StudentQuantile(0.975, 9), 2.262157, 5e-7);
  EXPECT_NEAR(StudentQuantile(0.975, 30), 2.042272, 5e-7);
  EXPECT_NEAR(StudentQuantile(0.95, 5), 2.015048, 5e-7);
  EXPECT_NEAR(StudentQuantile(0.995, 10), 3.169273, 5e-7);
  EXPECT_NEAR(StudentQuantile(0.025, 9), -2.262157, 5e-7);
}

TEST(MeanEstimate, EstimatesAMeanAsByHand) {
  // Mean 3; squares 4 + 1 + 0 + 1 + 4 = 10, s^2 = 10 / 4, s / sqrt(5) = 0.70710678; t_{0.975,4} = 2.776445.
  const MeanEstimate estimate = EstimateMean(std::vector<double>{5, 1, 3, 2, 4});
  EXPECT_DOUBLE_EQ(estimate.mean, 3);
  ASSERT_TRUE(estimate.half_width);
  EXPECT_NEAR(*estimate.half_width, 2.776445 * 0.70710678, 1e-6);
}

TEST(MeanEstimate, TakesTheConfidenceOnBothSides) {
  // Mean 2, s = sqrt(2), s / sqrt(2) = 1: the half width is t_{0.95,1} = 6.313752 itself.
  const MeanEstimate estimate = EstimateMean(std::vector<double>{1, 3}, 0.9);
  EXPECT_NEAR(estimate.half_width.value(), 6.313752, 5e-7);
}

TEST(MeanEstimate, GivesNoIntervalForASingleValue) {
  const MeanEstimate estimate = EstimateMean(std::vector<double>{13.352});
  EXPECT_EQ(estimate.mean, 13.352);
  EXPECT_FALSE(estimate.half_width);
}

TEST(MeanEstimate, FindsNoSpreadInEqualValues) {
  EXPECT_EQ(EstimateMean(std::vector<double>{4, 4, 4}).half_width.value(), 0);
}

TEST(MeanEstimateDeathTest, RefusesAnEmptySampleAndAnImpossibleConfidence) {
  EXPECT_DEATH(EstimateMean({}), "empty");
  EXPECT_DEATH(EstimateMean(std::vector<double>{1, 2}, 1), "confidence");
}

}  // namespace
}  // namespace fresco
