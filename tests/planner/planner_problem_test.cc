// The planner's whole numbers: weights, and how many dear slots a situation allows.
#include "planner/planner_problem.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <vector>

#include "tests/planner/exhaustive_search.h"
#include "tests/worlds/literal_model.h"
#include "tests/worlds/test_scenarios.h"

namespace fresco {
namespace {

Scenario Weighted(const std::vector<double>& weights) {
  Scenario scenario = TableOneScenario();
  scenario.sensors.clear();
  for (const double weight : weights) {
    scenario.sensors.push_back({100, 100, weight});
  }
  return scenario;
}

struct WholeWeights {
  std::vector<double> given;
  std::vector<int64_t> whole;
};

TEST(PlannerProblem, TakesWeightsAsMultiplesOfTheirLargestCommonFraction) {
  for (const WholeWeights& weights : std::vector<WholeWeights>{{{1, 1, 1}, {1, 1, 1}},
                                                               {{0.3, 0.3}, {1, 1}},
                                                               {{1, 2, 3}, {1, 2, 3}},
                                                               {{4, 6}, {2, 3}},
                                                               {{0.25, 0.75, 1}, {1, 3, 4}},
                                                               {{0.1, 0.3, 0.7}, {1, 3, 7}},
                                                               {{0.2, 0.3}, {2, 3}},
                                                               {{1.0 / 3, 1}, {1, 3}},
                                                               {{0.123, 0.456}, {41, 152}},
                                                               {{1e-5, 1e6}, {1, 100'000'000'000}},
                                                               {{0, 5, 0, 10}, {1, 2}}}) {
    SCOPED_TRACE(weights.given[0]);
    const UavWorld world(Weighted(weights.given));
    const PlannerProblem problem(world);
    EXPECT_TRUE(problem.has_exact_weights());
    EXPECT_EQ(problem.weights(), weights.whole);
    // All AoI 1 throughout is an average AoI of 1.
    int64_t cost = 0;
    for (const int64_t weight : problem.weights()) {
      cost += weight * problem.slots();
    }
    EXPECT_NEAR(static_cast<double>(cost) * problem.average_aoi_per_unit(), 1, 1e-12);
  }
}

TEST(PlannerProblem, RoundsOtherWeightsDownByTheLeastBit) {
  const std::vector<double> given = {1, std::sqrt(2), 1e-12};
  const UavWorld world(Weighted(given));
  const PlannerProblem problem(world);
  EXPECT_FALSE(problem.has_exact_weights());
  const double sum = given[0] + given[1] + given[2];
  for (size_t n = 0; n < given.size(); ++n) {
    const double share = static_cast<double>(problem.weights()[n]) * problem.average_aoi_per_unit() * 70;
    EXPECT_LE(share, given[n] / sum * (1 + 1e-15));
    EXPECT_GE(share, given[n] / sum - 1e-11);
  }
}

// A situation allows so many dear slots iff exhaustive search finds a way home after them, and not after
// one more.
TEST(PlannerProblem, AllowsAsManyDearSlotsAsLeaveAWayHome) {
  int allowed = 0;
  int forbidden = 0;
  for (uint32_t index = 0; index < 150; ++index) {
    SCOPED_TRACE(index);
    const Scenario scenario = TinyScenario(index);
    const UavWorld world(scenario);
    const PlannerProblem problem(world);
    EXPECT_EQ(problem.energy_binds(), EnergyBinds(scenario));
    const double flying_j = LiteralPower(scenario.rotor, scenario.speed_mps) * scenario.slot_s;
    const double hovering_j = LiteralPower(scenario.rotor, 0) * scenario.slot_s;
    for (int slot = 1; slot <= scenario.slots; ++slot) {
      for (int cell = 0; cell < problem.cells(); ++cell) {
        const Cell at = problem.CellAt(cell);
        const bool too_far_from_start =
            std::abs(at.column - scenario.start.column) + std::abs(at.row - scenario.start.row) > slot - 1;
        const int allowance = problem.DearAllowance(slot, cell);
        for (int dear = 0; dear < slot; ++dear) {
          const double used_j =
              dear * std::max(flying_j, hovering_j) + (slot - 1 - dear) * std::min(flying_j, hovering_j);
          const bool way_home =
              !too_far_from_start &&
              SomeFlightReachesStop(scenario, at, scenario.slots - slot, scenario.initial_energy_j - used_j);
          EXPECT_EQ(dear <= allowance, way_home) << slot << ' ' << cell << ' ' << dear;
          (way_home ? allowed : forbidden)++;
        }
      }
    }
  }
  EXPECT_GT(allowed, 1000);
  EXPECT_GT(forbidden, 1000);
}

}  // namespace
}  // namespace fresco
