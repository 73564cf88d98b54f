#include "worlds/uav/aoi_figures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "tests/worlds/table_one.h"
#include "tests/worlds/test_scenarios.h"

namespace fresco {
namespace {

Episode FlyRandomly(const UavWorld& world, uint32_t index, bool safe) {
  RandomStream stream = TestStream(6, index);
  return Fly(world, [&](const UavEnvironment& environment) {
    return RandomAction(world, environment, {.safe_actions = safe}, &stream);
  });
}

TEST(AoiFigures, AreThoseWorkedByHand) {
  const UavWorld world(SquareField(2, 4, {0, 0}, {1, 0}, {{0, 0, 1}, {25, 0, 3}}, 0));
  const Action actions[] = {{Move::kHover, 0}, {Move::kHover, 1}, {Move::kEast, 2}};
  const Episode flight =
      Fly(world, [&](const UavEnvironment& environment) { return actions[environment.state().slot - 1]; });
  // Ages (1,1), (2,2), (1,3), (2,4): sensor 2 is out of coverage in slot 3.
  ASSERT_EQ(StatesIn(flight).size(), 4u);
  EXPECT_TRUE(Arrived(flight));
  const AoiFigures figures = Figures(world, flight);
  EXPECT_EQ(figures.total_aoi, 16);
  EXPECT_DOUBLE_EQ(figures.sum_aoi, 4);
  EXPECT_DOUBLE_EQ(figures.average_aoi, ((1 + 2 + 1 + 2) * 0.25 + (1 + 2 + 3 + 4) * 0.75) / 4);
  EXPECT_NEAR(ResidualEnergy(world, flight), 22000 - 2 * 219.82 - 112.8758628, 1e-6);
}

// sum_t r_t = -(J - (1/T) sum_n theta_n delta_{n,1}) + k3.
TEST(AoiFigures, HaveTheReturnAsObjective) {
  for (uint32_t index = 0; index < 500; ++index) {
    const UavWorld world(RandomScenario(index));
    const Episode flight = FlyRandomly(world, index, true);
    ASSERT_TRUE(Arrived(flight));
    const double first = 1.0 / world.scenario().slots;
    const double average_aoi = Figures(world, flight).average_aoi;
    const double total_reward = std::accumulate(flight.rewards.begin(), flight.rewards.end(), 0.0);
    EXPECT_NEAR(total_reward, -(average_aoi - first) + world.scenario().reward.k3, 1e-5);
  }
}

TEST(AoiFigures, OfAnEarlyEndAreThoseWithoutAnyFurtherCollection) {
  Scenario scenario = SquareField(3, 6, {0, 0}, {0, 0}, {{0, 0, 1}, {50, 50, 1}});
  scenario.maximum_aoi = 5;
  const UavWorld world(scenario);
  const Episode flight = Fly(world, [](const UavEnvironment& environment) {
    return Action{environment.state().slot < 3 ? Move::kNorth : Move::kEast, 1};
  });
  // Within R = 100 m everywhere: (1,1), (1,2), (1,3), then lost at (1,4) in slot 4; (2,5), (3,5).
  EXPECT_EQ(OutcomeOf(flight), Outcome::kOutOfTime);
  EXPECT_EQ(StatesIn(flight).size(), 4u);
  EXPECT_EQ(Figures(world, flight).total_aoi, 2 + 3 + 4 + 5 + 7 + 8);
}

TEST(AoiFigures, NeverLookBetterForEndingEarly) {
  int early = 0;
  for (uint32_t index = 0; index < 500; ++index) {
    const UavWorld world(RandomScenario(index));
    const Episode flight = FlyRandomly(world, index, false);
    const int slots = world.scenario().slots;
    early += Arrived(flight) ? 0 : 1;
    const double smallest =
        world.sensors() == 1 || world.scenario().maximum_aoi ? 1.0 : 1.0 * world.sensors();
    EXPECT_GE(Figures(world, flight).sum_aoi, smallest);
    EXPECT_LE(Figures(world, flight).sum_aoi, world.sensors() * (slots + 1) / 2.0);
  }
  EXPECT_GT(early, 100);
}

TEST(AoiFigures, KeepAgesAndInputsWithinTheirBounds) {
  for (uint32_t index = 0; index < 300; ++index) {
    const UavWorld world(RandomScenario(index));
    std::vector<float> input(static_cast<size_t>(world.observation_size()));
    for (const UavState& state : StatesIn(FlyRandomly(world, index, true))) {
      const auto [youngest, oldest] = std::minmax_element(state.aoi.begin(), state.aoi.end());
      EXPECT_GE(*youngest, 1);
      EXPECT_LE(*oldest, state.slot);
      world.Observe(FieldsOf(state), input);
      for (const float value : input) {
        EXPECT_GE(value, 0.0f);
        EXPECT_LE(value, 1.0f);
      }
    }
  }
}

TEST(AoiFiguresDeathTest, RefuseAnEpisodeWithoutStates) {
  const UavWorld world(TableOneScenario());
  EXPECT_DEATH(Figures(world, Episode{}), "state_size");
}

}  // namespace
}  // namespace fresco
