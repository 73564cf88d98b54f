// The search beside the training gives what the planner gives, and ends when it is told to.
#include "learner/optimum_search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/learner/literal_run.h"

namespace fresco {
namespace {

constexpr int64_t kPatienceUs = 60'000'000;

class OptimumSearchTest : public ::testing::Test {
 protected:
  World world_{SmallExperiment().scenario()};
};

/// Far more than a test would wait for.
World HardWorld() {
  Scenario scenario;
  scenario.slots = 200;
  scenario.coverage_radius_m = 150;
  scenario.initial_energy_j = 50'000;
  scenario.sensors = RandomSensors(scenario.columns, scenario.rows, scenario.cell_m, 12, 1);
  return World(scenario);
}

TEST_F(OptimumSearchTest, FindsThePlannersOptimum) {
  const Plan plan = PlanOptimally(world_);
  OptimumSearch search(world_, {});
  ASSERT_TRUE(search.WaitForEnd(kPatienceUs));
  ASSERT_NE(search.plan(), nullptr);
  EXPECT_TRUE(search.plan()->optimal);
  EXPECT_EQ(Figures(world_, search.plan()->flight).total_aoi, Figures(world_, plan.flight).total_aoi);
  EXPECT_TRUE(search.bound()->proved);
  EXPECT_EQ(search.bound()->lower_bound_average_aoi, plan.lower_bound_average_aoi);
  EXPECT_EQ(search.seconds_left(), 0);
}

TEST_F(OptimumSearchTest, SearchesForNothingWithoutTime) {
  OptimumSearch search(world_, {0, 1'000'000'000});
  EXPECT_TRUE(search.WaitForEnd(0));
  EXPECT_EQ(search.plan(), nullptr);
  EXPECT_FALSE(search.bound().has_value());
}

TEST_F(OptimumSearchTest, HasAFlightAndABoundWhenItIsStopped) {
  const World world = HardWorld();
  OptimumSearch search(world, {1e6, 500'000'000});
  EXPECT_GT(search.seconds_left(), 0);
  search.Stop();
  EXPECT_TRUE(search.WaitForEnd(0));
  ASSERT_NE(search.plan(), nullptr);
  EXPECT_FALSE(search.plan()->optimal);
  EXPECT_TRUE(search.plan()->flight.arrived());
  EXPECT_FALSE(search.bound()->proved);
  EXPECT_LT(search.plan()->lower_bound_average_aoi, Figures(world, search.plan()->flight).average_aoi);
}

TEST_F(OptimumSearchTest, EndsAtItsTimeLimit) {
  const World world = HardWorld();
  OptimumSearch search(world, {0.01, 500'000'000});
  EXPECT_TRUE(search.WaitForEnd(kPatienceUs));
  ASSERT_NE(search.plan(), nullptr);
  EXPECT_FALSE(search.plan()->optimal);
}

}  // namespace
}  // namespace fresco
