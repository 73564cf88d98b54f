// The exact planner stopped early or starved of memory: it still has a flight and a true bound.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "planner/label_search.h"
#include "planner/planner.h"
#include "tests/planner/exhaustive_search.h"
#include "tests/worlds/table_one.h"

namespace fresco {
namespace {

void ExpectHolds(const UavWorld& world, const Plan& plan, double optimum) {
  constexpr double kRounding = 1e-9;
  const double found = Figures(world, plan.flight).average_aoi;
  EXPECT_TRUE(Arrived(plan.flight));
  EXPECT_GE(ResidualEnergy(world, plan.flight), 0);
  EXPECT_GE(plan.lower_bound_average_aoi, 1 - kRounding);  // an AoI is never below 1
  EXPECT_LE(plan.lower_bound_average_aoi, optimum + kRounding);
  EXPECT_GE(found, optimum - kRounding);
  if (plan.optimal) {
    EXPECT_NEAR(found, optimum, kRounding);
    EXPECT_EQ(plan.lower_bound_average_aoi, found);
  } else {
    EXPECT_LT(plan.lower_bound_average_aoi, found);
  }
}

/// Counts how often it is asked, and says no for the `last`th time.
struct Stopper {
  int last = 0;
  int calls = 0;
  int calls_before_search = 0;
  bool asked_twice_in_a_slot = false;
  std::set<std::pair<int64_t, int>> slots;

  PlannerOptions Options() {
    return {.keep_going = [this](const PlannerProgress& progress) {
      ++calls;
      calls_before_search += progress.width == 0;
      asked_twice_in_a_slot = asked_twice_in_a_slot ||
                              (progress.width > 0 && !slots.insert({progress.width, progress.slot}).second);
      EXPECT_LE(progress.lower_bound_average, progress.best_average);
      return calls != last;
    }};
  }
};

// So few labels a slot that the optimum's are dropped on the way: the bound has to remember them.
TEST(PlannerProgress, ClaimsNoMoreThanIsProvedWhereLabelsAreDropped) {
  const UavWorld world(SquareField(14, 50, {7, 0}, {7, 13}, RandomSensors(14, 14, 25, 3, 1)));
  const Plan plan = PlanOptimally(world, 0);
  const int64_t optimum = Figures(world, plan.flight).total_aoi;  // in the problem's units, weights being 1
  int64_t largest_bound = 0;
  WorkMeter meter([&](const SearchProgress& progress) {
    largest_bound = std::max(largest_bound, progress.least_bound);
    return true;
  });
  const PlannerProblem problem(world);
  const LowerBound lower_bound(problem, int64_t{1} << 30, meter);
  const CoverageDistances distances(problem, meter);
  largest_bound = 0;  // of the search alone
  constexpr int64_t kWidth = 3;
  const LabelSearchResult result = SearchLabels(problem, lower_bound, distances, 2 * optimum, kWidth, meter);
  ASSERT_GT(result.cost, optimum);
  EXPECT_GT(largest_bound, 0);
  EXPECT_LE(largest_bound, optimum);
}

Plan PlanUntilCall(const UavWorld& world, int last, Stopper* stopper) {
  *stopper = {};
  stopper->last = last;
  return PlanOptimally(world, 0, stopper->Options());
}

TEST(PlannerStopped, AtAnyCallItHasAFlightAndATrueBoundAndAsksNoMore) {
  int stops = 0;
  int unproved = 0;
  for (uint32_t index = 0; index < 200; ++index) {
    SCOPED_TRACE(index);
    const Scenario scenario = TinyScenario(index);
    const UavWorld world(scenario);
    const double optimum = ExhaustiveSearch(scenario).LeastAverageAoi();
    Stopper stopper;
    PlanUntilCall(world, 0, &stopper);
    const int calls = stopper.calls;
    for (int last = 1; last <= calls; ++last) {
      const Plan plan = PlanUntilCall(world, last, &stopper);
      EXPECT_EQ(stopper.calls, last);
      ExpectHolds(world, plan, optimum);
      ++stops;
      unproved += !plan.optimal;
    }
  }
  EXPECT_GT(stops, 100);
  EXPECT_GT(unproved, 50);
}

// Large enough that tables and slots take more work than one call's.
Scenario MediumScenario(int sensors, double radius_m) {
  return SquareField(12, 36, {5, 0}, {5, 11}, RandomSensors(12, 12, 25, sensors, 5), radius_m);
}

TEST(PlannerStopped, AsksByWorkWhileTablesAreBuiltToo) {
  const UavWorld world(MediumScenario(3, 50));
  Stopper stopper;
  const Plan whole = PlanUntilCall(world, 0, &stopper);
  ASSERT_TRUE(whole.optimal);
  const double optimum = whole.lower_bound_average_aoi;
  const int calls = stopper.calls;
  const int calls_before_search = stopper.calls_before_search;
  EXPECT_GT(calls_before_search, 2);
  EXPECT_GE(calls, calls_before_search + world.scenario().slots - 1);
  for (const int last : {1, calls_before_search / 2, calls_before_search, calls_before_search + 1, calls}) {
    SCOPED_TRACE(last);
    const Plan plan = PlanUntilCall(world, last, &stopper);
    EXPECT_EQ(stopper.calls, last);
    EXPECT_FALSE(plan.optimal);
    ExpectHolds(world, plan, optimum);
  }
}

TEST(PlannerStopped, AsksInsideWideSlots) {
  const UavWorld world(MediumScenario(8, 90));
  Stopper stopper;
  PlannerOptions options = stopper.Options();
  const auto count = options.keep_going;
  options.keep_going = [&](const PlannerProgress& progress) {
    return count(progress) && !stopper.asked_twice_in_a_slot;
  };
  const Plan plan = PlanOptimally(world, 0, options);
  EXPECT_TRUE(stopper.asked_twice_in_a_slot);
  EXPECT_FALSE(plan.optimal);
  EXPECT_TRUE(Arrived(plan.flight));
}

// Tables of gigabytes, were they all wanted.
TEST(PlannerStopped, HugeScenariosStopWhileTheyAreSetUp) {
  Scenario scenario = SquareField(60, 300, {0, 0}, {59, 59}, RandomSensors(60, 60, 25, 40, 1));
  scenario.initial_energy_j = 60000;
  const UavWorld world(scenario);
  for (const int last : {1, 2, 5}) {
    SCOPED_TRACE(last);
    Stopper stopper;
    const Plan plan = PlanUntilCall(world, last, &stopper);
    EXPECT_EQ(stopper.calls, last);
    EXPECT_EQ(stopper.calls_before_search, last);
    EXPECT_FALSE(plan.optimal);
    EXPECT_TRUE(Arrived(plan.flight));
    EXPECT_EQ(plan.lower_bound_total_aoi, 40.0 * 300);  // all that is known yet: 1 in every slot
    EXPECT_EQ(plan.labels, 0);
  }
}

TEST(PlannerStarved, ProvesWhatItsMemoryAllows) {
  int proved = 0;
  for (uint32_t index = 0; index < 120; ++index) {
    SCOPED_TRACE(index);
    const Scenario scenario = TinyScenario(index);
    const UavWorld world(scenario);
    const double optimum = ExhaustiveSearch(scenario).LeastAverageAoi();
    for (int64_t bytes = 512; bytes <= 65536; bytes *= 2) {
      const Plan plan = PlanOptimally(world, 0, {.memory_bytes = bytes});
      ExpectHolds(world, plan, optimum);
      proved += plan.optimal;
    }
  }
  EXPECT_GT(proved, 500);  // a hundred labels a slot go far in scenarios as tiny as these
}

TEST(PlannerStarved, WithNoMemoryToSpeakOfItStillFlies) {
  const UavWorld world(MediumScenario(3, 50));
  const Plan whole = PlanOptimally(world, 0);
  ASSERT_TRUE(whole.optimal);
  int unproved = 0;
  for (const int64_t bytes : {int64_t{0}, int64_t{200'000}, int64_t{1'000'000}, int64_t{2'000'000}}) {
    SCOPED_TRACE(bytes);
    const Plan plan = PlanOptimally(world, 0, {.memory_bytes = bytes});
    ExpectHolds(world, plan, whole.lower_bound_average_aoi);
    EXPECT_LE(plan.labels, int64_t{44} * std::max<int64_t>(100, bytes / 300));
    unproved += !plan.optimal;
  }
  EXPECT_GE(unproved, 1);
}

// What is said on the scale of total_aoi.
TEST(PlannerStopped, BoundsTheTotalInWholeNumbersWhereWeightsAreEqual) {
  for (uint32_t index = 0; index < 60; ++index) {
    Scenario scenario = TinyScenario(index);
    for (Sensor& sensor : scenario.sensors) {
      sensor.weight = sensor.weight > 0 ? 0.3 : 0;  // those of weight zero count in the total all the same
    }
    const UavWorld world(scenario);
    for (const int64_t bytes : {int64_t{0}, int64_t{4096}}) {
      const Plan plan = PlanOptimally(world, 0, {.memory_bytes = bytes});
      const auto total = static_cast<double>(Figures(world, plan.flight).total_aoi);
      EXPECT_EQ(plan.lower_bound_total_aoi, std::floor(plan.lower_bound_total_aoi));
      EXPECT_LE(plan.lower_bound_total_aoi, total);
      EXPECT_GE(plan.lower_bound_total_aoi, scenario.slots * world.sensors());
      if (plan.optimal) {
        EXPECT_EQ(plan.lower_bound_total_aoi, total);
      }
    }
  }
}

TEST(PlannerStopped, ScalesTheBoundWhereWeightsAreUnequal) {
  Scenario scenario = MediumScenario(3, 50);
  scenario.sensors[0].weight = 2;
  scenario.sensors[1].weight = 0;
  const UavWorld world(scenario);
  Stopper stopper;
  const Plan plan = PlanUntilCall(world, 1, &stopper);
  EXPECT_FALSE(plan.optimal);
  EXPECT_DOUBLE_EQ(plan.lower_bound_total_aoi, plan.lower_bound_average_aoi * 3 * scenario.slots);
}

}  // namespace
}  // namespace fresco
