// The search beside the training gives what the planner gives, and ends when it is told to.
#include "storage/optimum_search.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "tests/training/literal_run.h"
#include "tests/worlds/table_one.h"
#include "worlds/cartpole/cartpole.h"
#include "worlds/uav/aoi_figures.h"
#include "worlds/uav/flight.h"

namespace fresco {
namespace {

constexpr int64_t kPatienceUs = 60'000'000;

class OptimumSearchTest : public ::testing::Test {
 protected:
  const Experiment experiment_ = SmallExperiment();
  const UavWorld& world_ = RequireUavWorld(experiment_.world(), "the test");
};

/// Far more than a test would wait for.
UavWorld HardWorld() {
  Scenario scenario = TableOne();
  scenario.slots = 200;
  scenario.coverage_radius_m = 150;
  scenario.initial_energy_j = 50'000;
  scenario.sensors = RandomSensors(scenario.columns, scenario.rows, scenario.cell_m, 12, 1);
  return UavWorld(scenario);
}

TEST_F(OptimumSearchTest, FindsThePlannersOptimum) {
  const Plan plan = PlanOptimally(world_, 0);
  OptimumSearch search(world_, {0}, {});
  ASSERT_TRUE(search.WaitForEnd(kPatienceUs));
  const OptimumResult result = search.result();
  ASSERT_NE(result.plans.front(), nullptr);
  EXPECT_EQ(result.end, SearchEnd::kProved);
  EXPECT_TRUE(result.plans.front()->optimal);
  EXPECT_EQ(Figures(world_, result.plans.front()->flight).total_aoi, Figures(world_, plan.flight).total_aoi);
  EXPECT_TRUE(search.bounds().front().proved);
  EXPECT_EQ(search.bounds().front().lower_bound_average_aoi, plan.lower_bound_average_aoi);
  EXPECT_EQ(search.processor_seconds_left(), 0);
}

TEST_F(OptimumSearchTest, SearchesForNothingWithoutTime) {
  OptimumSearch search(world_, {0}, {0, 1'000'000'000});
  EXPECT_TRUE(search.WaitForEnd(0));
  EXPECT_EQ(search.result().plans.front(), nullptr);
  EXPECT_EQ(search.result().end, SearchEnd::kOff);
  EXPECT_EQ(search.bounds().front().lower_bound_average_aoi, 0);
}

TEST_F(OptimumSearchTest, SearchesForNothingInAWorldThatThePlannerDoesNotKnow) {
  const CartPole world(9);
  OptimumSearch search(world, {0}, {});
  EXPECT_TRUE(search.WaitForEnd(0));
  EXPECT_EQ(search.result().plans.front(), nullptr);
  EXPECT_EQ(search.result().end, SearchEnd::kOff);
  EXPECT_EQ(search.bounds().front().lower_bound_average_aoi, 0);
  EXPECT_EQ(search.processor_seconds_left(), 0);
}

TEST_F(OptimumSearchTest, HasAFlightAndABoundWhenItIsStopped) {
  const UavWorld world = HardWorld();
  OptimumSearch search(world, {0}, {1e6, 500'000'000});
  EXPECT_GT(search.processor_seconds_left(), 0);
  search.Stop();
  EXPECT_TRUE(search.WaitForEnd(0));
  const std::shared_ptr<const Plan> plan = search.result().plans.front();
  ASSERT_NE(plan, nullptr);
  EXPECT_EQ(search.result().end, SearchEnd::kStopped);
  EXPECT_FALSE(plan->optimal);
  EXPECT_TRUE(Arrived(plan->flight));
  EXPECT_FALSE(search.bounds().front().proved);
  EXPECT_LT(plan->lower_bound_average_aoi, Figures(world, plan->flight).average_aoi);
}

TEST_F(OptimumSearchTest, EndsAtItsLimitOfProcessorTime) {
  const UavWorld world = HardWorld();
  OptimumSearch search(world, {0}, {0.01, 500'000'000});
  EXPECT_TRUE(search.WaitForEnd(kPatienceUs));
  EXPECT_EQ(search.result().end, SearchEnd::kLimit);
  ASSERT_NE(search.result().plans.front(), nullptr);
  EXPECT_FALSE(search.result().plans.front()->optimal);
}

// As if the search's thread got a processor for none of the time that passes.
TEST_F(OptimumSearchTest, DoesNotCountTimeInWhichItGetsNoProcessor) {
  constexpr double kLimit = 1e-6;  // any search takes longer
  OptimumSearch search(world_, {0}, {kLimit, 500'000'000}, {}, [] { return int64_t{0}; });
  EXPECT_TRUE(search.WaitForEnd(kPatienceUs));
  EXPECT_EQ(search.result().end, SearchEnd::kProved);
}

TEST_F(OptimumSearchTest, EndsOnceItsProcessorTimeIsUsedHoweverShortTheWait) {
  OptimumSearch search(world_, {0}, {1e6, 500'000'000}, {}, [] { return int64_t{1'000'000'000'000}; });
  EXPECT_TRUE(search.WaitForEnd(kPatienceUs));
  EXPECT_EQ(search.result().end, SearchEnd::kLimit);
}

TEST_F(OptimumSearchTest, SaysHowMuchProcessorTimeIsLeft) {
  const UavWorld world = HardWorld();
  std::atomic<int64_t> taken_us = 0;
  OptimumSearch search(world, {0}, {100, 500'000'000}, {}, [&] { return taken_us.load(); });
  EXPECT_EQ(search.processor_seconds_left(), 100);
  taken_us = 40'000'000;
  while (search.processor_seconds_left() == 100) {
    std::this_thread::yield();
  }
  EXPECT_EQ(search.processor_seconds_left(), 60);
  taken_us = 100'000'000;
  EXPECT_TRUE(search.WaitForEnd(kPatienceUs));
  EXPECT_EQ(search.processor_seconds_left(), 0);
}

}  // namespace
}  // namespace fresco
