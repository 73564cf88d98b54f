#include "worlds/uav/uav_environment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "tests/worlds/table_one.h"
#include "tests/worlds/test_scenarios.h"

namespace fresco {
namespace {

using testing::ElementsAre;

// 3 x 3 cells, T = 6, from (0, 0) to (2, 0); sensor 1 over (0, 0), sensor 2 over (2, 1) with three
// times its weight, each covering its cell and the four beside it.
Scenario SmallScenario() {
  Scenario scenario = SquareField(3, 6, {0, 0}, {2, 0}, {{0, 0, 1}, {50, 25, 3}}, 25);
  scenario.reward = {10, 20, 5};
  return scenario;
}

void ExpectState(const UavEnvironment& environment, Cell cell, int time_margin, std::vector<int16_t> aoi) {
  EXPECT_EQ(environment.state().cell, cell);
  EXPECT_EQ(environment.state().time_margin, time_margin);
  EXPECT_EQ(environment.state().aoi, aoi);
}

TEST(UavEnvironment, FliesTheFlightWorkedByHand) {
  const UavWorld world(SmallScenario());
  UavEnvironment environment(world);
  ExpectState(environment, {0, 0}, 3, {1, 1});
  EXPECT_NEAR(environment.Step({Move::kNorth, 1}).reward, -1.75 / 6, 1e-15);
  ExpectState(environment, {0, 1}, 1, {1, 2});
  EXPECT_NEAR(environment.Step({Move::kEast, 2}).reward, -2.75 / 6, 1e-15);  // out of coverage
  ExpectState(environment, {1, 1}, 1, {2, 3});
  EXPECT_NEAR(environment.Step({Move::kHover, 2}).reward, -1.5 / 6, 1e-15);
  ExpectState(environment, {1, 1}, 0, {3, 1});
  EXPECT_NEAR(environment.Step({Move::kEast, 0}).reward, -2.5 / 6, 1e-15);
  ExpectState(environment, {2, 1}, 0, {4, 2});
  const StepResult last = environment.Step({Move::kSouth, 2});
  EXPECT_NEAR(last.reward, -2.0 / 6 + 5, 1e-15);
  EXPECT_TRUE(last.terminal());
  EXPECT_EQ(environment.outcome(), Outcome::kArrived);
  ExpectState(environment, {2, 0}, 0, {5, 1});
  EXPECT_NEAR(environment.remaining_energy_j(), 22000 - 219.82 - 4 * 112.8758628, 1e-6);
}

TEST(UavEnvironment, TransmitsFromWhereItIsBeforeItMoves) {
  Scenario scenario = SmallScenario();
  scenario.coverage_radius_m = 0;
  const UavWorld world(scenario);
  UavEnvironment environment(world);
  environment.Step({Move::kEast, 1});
  EXPECT_THAT(environment.state().aoi, ElementsAre(1, 2));
  environment.Step({Move::kWest, 1});  // flies back to the sensor, but transmits beside it
  EXPECT_THAT(environment.state().aoi, ElementsAre(2, 3));
}

TEST(UavEnvironment, StartsWithTheMarginsOfTableOne) {
  const UavWorld world(TableOneScenario());
  const UavEnvironment environment(world);
  EXPECT_EQ(environment.state().slot, 1);
  EXPECT_EQ(environment.state().time_margin, 50);
  EXPECT_NEAR(environment.state().energy_margin_j, 22000 - 69 * 112.8758628, 1e-3);
}

TEST(UavEnvironment, LowersTheEnergyMarginByHoversOnly) {
  const UavWorld world(TableOneScenario());
  UavEnvironment environment(world);
  const float before_j = environment.state().energy_margin_j;
  environment.Step({Move::kEast, 0});
  EXPECT_EQ(environment.state().energy_margin_j, before_j);
  environment.Step({Move::kHover, 0});
  EXPECT_NEAR(environment.state().energy_margin_j, before_j - 106.9441372, 1e-3);
}

TEST(UavEnvironment, CountsAMoveOffTheGridAsAHover) {
  const UavWorld world(TableOneScenario());
  UavEnvironment hovering(world);
  UavEnvironment blocked(world);
  hovering.Step({Move::kHover, 2});
  blocked.Step({Move::kSouth, 2});
  EXPECT_EQ(blocked.state().cell, (Cell{10, 0}));
  EXPECT_EQ(blocked.state().time_margin, hovering.state().time_margin);
  EXPECT_EQ(blocked.remaining_energy_j(), hovering.remaining_energy_j());
}

TEST(UavEnvironment, EndsWhereTheStopIsOutOfReachInTime) {
  const UavWorld world(SmallScenario());
  UavEnvironment environment(world);
  environment.Step({Move::kNorth, 0});
  const StepResult result = environment.Step({Move::kNorth, 0});
  EXPECT_TRUE(result.terminal());
  EXPECT_EQ(environment.outcome(), Outcome::kOutOfTime);
  EXPECT_EQ(environment.state().time_margin, -1);
  EXPECT_NEAR(result.reward, -3.0 / 6 - 10, 1e-12);
}

TEST(UavEnvironment, EndsWhereTheEnergyDoesNotSuffice) {
  Scenario scenario = SmallScenario();
  scenario.initial_energy_j = 5 * 112.8758628 + 110;  // one hover and no more
  const UavWorld world(scenario);
  UavEnvironment environment(world);
  EXPECT_FALSE(environment.Step({Move::kHover, 0}).terminal());
  EXPECT_EQ(environment.outcome(), Outcome::kFlying);
  const StepResult result = environment.Step({Move::kHover, 0});
  EXPECT_TRUE(result.terminal());
  EXPECT_EQ(environment.outcome(), Outcome::kOutOfEnergy);
  EXPECT_NEAR(result.reward, -3.0 / 6 - 20, 1e-12);
}

TEST(UavEnvironment, ChargesBothPenaltiesWhereOneMoveBreaksBoth) {
  Scenario scenario = SmallScenario();
  scenario.slots = 3;
  scenario.initial_energy_j = 2 * 112.8758628 + 1;
  const UavWorld world(scenario);
  UavEnvironment environment(world);
  const StepResult result = environment.Step({Move::kHover, 0});
  EXPECT_TRUE(result.terminal());
  EXPECT_EQ(environment.outcome(), Outcome::kOutOfTime);
  EXPECT_NEAR(result.reward, -2.0 / 3 - 10 - 20, 1e-12);
}

TEST(UavEnvironment, CapsTheAoi) {
  Scenario scenario = SmallScenario();
  scenario.maximum_aoi = 2;
  const UavWorld world(scenario);
  UavEnvironment environment(world);
  for (int slot = 0; slot < 3; ++slot) {
    environment.Step({Move::kHover, 0});
  }
  EXPECT_THAT(environment.state().aoi, ElementsAre(2, 2));
}

TEST(UavEnvironment, KeepsItsMarginWhereFlyingIsTheDearerAndSlackIsHovered) {
  Scenario scenario = SmallScenario();
  scenario.rotor = LiteratureRotor();
  const UavWorld world(scenario);
  UavEnvironment environment(world);
  const double difference_j = world.flying_energy_j() - world.hovering_energy_j();
  const double first_j = 22000 - 2 * world.flying_energy_j() - 3 * world.hovering_energy_j();
  EXPECT_NEAR(environment.state().energy_margin_j, first_j, 1e-3);
  environment.Step({Move::kHover, 0});
  EXPECT_NEAR(environment.state().energy_margin_j, first_j, 1e-3);
  environment.Step({Move::kNorth, 0});  // away, and back again later: two flown instead of two hovered
  EXPECT_NEAR(environment.state().energy_margin_j, first_j - 2 * difference_j, 1e-3);
}

TEST(UavEnvironment, ResetIsANewBeginning) {
  const UavWorld world(SmallScenario());
  UavEnvironment used(world);
  used.Step({Move::kHover, 1});
  used.Reset();
  const UavEnvironment fresh(world);
  EXPECT_EQ(used.state().slot, 1);
  ExpectState(used, fresh.state().cell, fresh.state().time_margin, fresh.state().aoi);
  EXPECT_EQ(used.remaining_energy_j(), fresh.remaining_energy_j());
}

TEST(UavEnvironment, MasksWhatIsUnsafeOrUncovered) {
  const UavWorld world(SmallScenario());
  const UavEnvironment environment(world);  // over (0, 0): south and west leave the grid
  std::vector<uint8_t> mask(15);
  environment.WriteMask({}, mask);
  EXPECT_THAT(mask, testing::Each(1));
  environment.WriteMask({.safe_actions = true}, mask);
  EXPECT_THAT(mask, ElementsAre(1, 1, 1, 0, 0, 0, 1, 1, 1, 0, 0, 0, 1, 1, 1));
  environment.WriteMask({.coverage = true}, mask);
  EXPECT_THAT(mask, ElementsAre(1, 1, 0, 1, 1, 0, 1, 1, 0, 1, 1, 0, 1, 1, 0));
  environment.WriteMask({.safe_actions = true, .coverage = true}, mask);
  EXPECT_THAT(mask, ElementsAre(1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0));
}

TEST(UavEnvironment, MasksIdlingOnlyWhileASensorIsCovered) {
  const UavWorld world(SmallScenario());
  UavEnvironment environment(world);
  std::vector<uint8_t> mask(15);
  environment.WriteMask({.idle = true}, mask);  // sensor 1 is covered
  EXPECT_THAT(mask, ElementsAre(0, 1, 1, 0, 1, 1, 0, 1, 1, 0, 1, 1, 0, 1, 1));
  environment.WriteMask({.safe_actions = true, .coverage = true, .idle = true}, mask);
  EXPECT_THAT(mask, ElementsAre(0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0));
}

TEST(UavEnvironment, MasksNothingOnceTheEpisodeIsOver) {
  const UavWorld world(SmallScenario());
  UavEnvironment environment(world);
  environment.Step({Move::kNorth, 0});
  environment.Step({Move::kNorth, 0});
  ASSERT_EQ(environment.outcome(), Outcome::kOutOfTime);
  std::vector<uint8_t> mask(15);
  environment.WriteMask({.safe_actions = true, .coverage = true}, mask);
  EXPECT_THAT(mask, testing::Each(1));
}

TEST(UavEnvironmentDeathTest, RefusesAStepAfterTheEnd) {
  const UavWorld world(SmallScenario());
  UavEnvironment environment(world);
  environment.Step({Move::kNorth, 0});
  environment.Step({Move::kNorth, 0});
  EXPECT_DEATH(environment.Step({Move::kHover, 0}), "Outcome::kFlying");
}

}  // namespace
}  // namespace fresco
