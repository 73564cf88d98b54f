// Means and intervals by hand and from published tables. A run whose optimum is not proved has no gap, and is
// part of no mean over gaps or optima.
#include "paper/study_statistics.h"

#include <gtest/gtest.h>

namespace fresco {
namespace {

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
