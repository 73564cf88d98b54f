// Means and intervals by hand and from published tables. A run whose optimum is not proved has no gap, and is
// part of no mean over gaps or optima.
#include "paper/study_statistics.h"

#include <gtest/gtest.h>

namespace fresco {
namespace {

TEST(Statistics, HasTheQuantilesOfThePublishedTables) {
  // NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.6.7.2, with more digits.
  EXPECT_NEAR(StudentQuantile(0.975, 1), 12.706205, 5e-7);
  EXPECT_NEAR(StudentQuantile(0.975, 2), 4.302653, 5e-7);
  EXPECT_NEAR(StudentQuantile(0.975, 9), 2.262157, 5e-7);
  EXPECT_NEAR(StudentQuantile(0.975, 30), 2.042272, 5e-7);
  EXPECT_NEAR(StudentQuantile(0.95, 5), 2.015048, 5e-7);
  EXPECT_NEAR(StudentQuantile(0.995, 10), 3.169273, 5e-7);
  EXPECT_NEAR(StudentQuantile(0.025, 9), -2.262157, 5e-7);
}

TEST(Statistics, EstimatesAMeanAsByHand) {
  // Mean 3; squares 4 + 1 + 0 + 1 + 4 = 10, s^2 = 10 / 4, s / sqrt(5) = 0.70710678; t_{0.975,4} = 2.776445.
  const MeanEstimate estimate = EstimateMean(std::vector<double>{5, 1, 3, 2, 4});
  EXPECT_DOUBLE_EQ(estimate.mean, 3);
  ASSERT_TRUE(estimate.half_width);
  EXPECT_NEAR(*estimate.half_width, 2.776445 * 0.70710678, 1e-6);
}

TEST(Statistics, TakesTheConfidenceOnBothSides) {
  // Mean 2, s = sqrt(2), s / sqrt(2) = 1: the half width is t_{0.95,1} = 6.313752 itself.
  const MeanEstimate estimate = EstimateMean(std::vector<double>{1, 3}, 0.9);
  EXPECT_NEAR(estimate.half_width.value(), 6.313752, 5e-7);
}

TEST(Statistics, GivesNoIntervalForASingleValue) {
  const MeanEstimate estimate = EstimateMean(std::vector<double>{13.352});
  EXPECT_EQ(estimate.mean, 13.352);
  EXPECT_FALSE(estimate.half_width);
}

TEST(Statistics, FindsNoSpreadInEqualValues) {
  EXPECT_EQ(EstimateMean(std::vector<double>{4, 4, 4}).half_width.value(), 0);
}

TEST(StatisticsDeathTest, RefusesAnEmptySampleAndAnImpossibleConfidence) {
  EXPECT_DEATH(EstimateMean({}), "empty");
  EXPECT_DEATH(EstimateMean(std::vector<double>{1, 2}, 1), "confidence");
}

StudyResult ResultWith(const std::string& optimum) {
  return ResultOf(R"({"arrived": true, "average_aoi": 12, "total_aoi": 120, "updates": 1,
      "weights_crc32c": "00000000", "lower_bound_average_aoi": 2.5,
      "baselines": {"aoi": {"average_aoi": 20, "total_aoi": 200},
                    "distance": {"average_aoi": 30, "total_aoi": 300}}, )" +
                      optimum + "}",
                  "run");
}

StudyResult Unproved() {
  return ResultWith(R"("optimal_average_aoi": null, "optimal_total_aoi": null)");
}

StudyResult Proved(double gap_percent) {
  StudyResult result = Unproved();
  result.optimal = {10, 100};
  result.gap_percent = gap_percent;
  return result;
}

TEST(StudyResult, HasAGapOnlyToAProvedOptimum) {
  EXPECT_FALSE(Unproved().gap_percent);
  EXPECT_FALSE(Unproved().optimal);
  EXPECT_EQ(Unproved().lower_bound_average_aoi, 2.5);
  const StudyResult proved = ResultWith(R"("optimal_average_aoi": 2.5, "optimal_total_aoi": 25)");
  EXPECT_EQ(proved.optimal->total_aoi, 25);
  EXPECT_EQ(proved.gap_percent, 380);
}

TEST(Group, AveragesTheGapsOfProvedOptimaOnly) {
  const Group group{4, {Proved(1), Unproved(), Proved(3)}};
  EXPECT_EQ(group.Gaps(), (std::vector<double>{1, 3}));
  EXPECT_EQ(group.Gap()->mean, 2);
  EXPECT_EQ(group.LargestGap(), 3);
}

TEST(Group, HasNoMeanOptimumIfOneIsNotProved) {
  const Group group{4, {Proved(1), Unproved()}};
  const Group proved{4, {Proved(1), Proved(2)}};
  for (const Policy& policy : kPolicies) {
    EXPECT_EQ(group.Average(policy).has_value(), policy.role != CurveRole::kOptimum) << policy.name;
    EXPECT_TRUE(proved.Average(policy)) << policy.name;
  }
}

TEST(Group, HasNoGapIfNoOptimumIsProved) {
  const Group group{4, {Unproved()}};
  EXPECT_FALSE(group.Gap());
  EXPECT_FALSE(group.LargestGap());
}

}  // namespace
}  // namespace fresco
