#include "worlds/uav/network_input.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/worlds/table_one.h"
#include "tests/worlds/test_scenarios.h"
#include "worlds/uav/uav_environment.h"

namespace fresco {
namespace {

using testing::ElementsAre;
using testing::FloatEq;

std::vector<float> InputOf(const Scenario& scenario, const UavState& state,
                           NetworkInputOptions options = {}) {
  const UavWorld world(scenario, {.network_input = options});
  std::vector<float> input(static_cast<size_t>(world.observation_size()), -9.0f);
  const UavWorld plain(scenario);  // a NetworkInput goes by its own options
  NetworkInput(plain, options).Write(FieldsOf(state), input);
  std::vector<float> observed(input.size(), -9.0f);
  world.Observe(FieldsOf(state), observed);
  EXPECT_EQ(observed, input);
  return input;
}

TEST(NetworkInput, IsTheStateScaledToOne) {
  const Scenario scenario = TableOneScenario();
  const UavState state{
      .slot = 20, .cell = {19, 5}, .time_margin = 35, .energy_margin_j = 5500, .aoi = {7, 14, 70}};
  EXPECT_THAT(InputOf(scenario, state), ElementsAre(1.0f, 5.0f / 19.0f, 0.1f, 0.2f, 1.0f, 0.5f, 0.25f));
}

TEST(NetworkInput, IsZeroAlongAnAxisOfOneCell) {
  const Scenario scenario = SquareField(1, 70, {0, 0}, {0, 0}, {{0, 0, 1}});
  const UavState state{.slot = 1, .cell = {0, 0}, .time_margin = 70, .energy_margin_j = 0, .aoi = {1}};
  EXPECT_THAT(InputOf(scenario, state), ElementsAre(0.0f, 0.0f, 1.0f / 70.0f, 1.0f, 0.0f));
  EXPECT_THAT(InputOf(scenario, state, {.sensor_geometry = true}),
              ElementsAre(0.0f, 0.0f, 1.0f / 70.0f, 1.0f, 0.0f, 1.0f, 0.0f));
}

TEST(NetworkInput, ShowsCoverageAndDistancesOfTheCellWithSensorGeometry) {
  // Sensors at (200, 175), (25, 100) and (450, 475) m, R = 100 m; the grid's longer side is 500 m.
  const Scenario scenario = TableOneScenario();
  const UavState state{
      .slot = 20, .cell = {11, 8}, .time_margin = 35, .energy_margin_j = 5500, .aoi = {7, 14, 70}};
  // The UAV is over (275, 200) m: hypot(75, 25), hypot(250, 100) and hypot(175, 275) m away.
  EXPECT_THAT(
      InputOf(scenario, state, {.sensor_geometry = true}),
      ElementsAre(11.0f / 19.0f, 8.0f / 19.0f, 0.1f, 0.2f, 1.0f, 0.5f, 0.25f, 1.0f, 0.0f, 0.0f,
                  FloatEq(79.0569415f / 500), FloatEq(269.258240f / 500), FloatEq(325.960120f / 500)));
}

TEST(NetworkInput, ShowsEverySensorFromHereWithSets) {
  // The UAV is over (275, 200) m, the stop is cell (10, 19); coverage and distances are those above.
  Scenario scenario = TableOneScenario();
  scenario.sensors[1].weight = 2;
  const UavState state{
      .slot = 20, .cell = {11, 8}, .time_margin = 35, .energy_margin_j = 5500, .aoi = {7, 14, 70}};
  EXPECT_THAT(
      InputOf(scenario, state, {.sets = true}),
      ElementsAre(FloatEq(11.0f / 20), FloatEq(8.0f / 20), FloatEq(-1.0f / 20), FloatEq(11.0f / 20), 0.5f,
                  0.25f,
                  FloatEq(static_cast<float>(scenario.coverage_radius_m) / 500),  //
                  FloatEq(12.0f / 20), 1.0f, -1.0f, -1.0f, 1.0f,
                  // After a move to the east, the first sensor is 103.08 m away.
                  1.0f, FloatEq(-0.15f), FloatEq(-0.05f), FloatEq(79.0569415f / 500), 1.0f, 0.1f, 0.25f,  //
                  0.0f, 0.0f, 0.0f, -1.0f, 0.0f,
                  // The others are 10 cells west, 4 south and 7 east, 11 north. Five moves from there, as two
                  // and three cells, still cover them.
                  1.0f, FloatEq(-0.5f), FloatEq(-0.2f), FloatEq(269.258240f / 500), 0.0f, 0.2f, 0.5f,   //
                  FloatEq(9.0f / 20), -1.0f, 1.0f, -1.0f, 1.0f,                                         //
                  1.0f, FloatEq(0.35f), FloatEq(0.55f), FloatEq(325.960120f / 500), 0.0f, 1.0f, 0.25f,  //
                  FloatEq(13.0f / 20), 1.0f, -1.0f, 1.0f, -1.0f));
  const UavWorld world(scenario, {.network_input = {.sets = true}});
  ASSERT_TRUE(world.description().sets);
  EXPECT_EQ(world.description().sets->own_inputs, 12);
  EXPECT_EQ(world.description().sets->items, 3);
  EXPECT_EQ(world.description().sets->item_inputs, 12);
  EXPECT_EQ(world.description().sets->groups, kMoves);
  EXPECT_FALSE(UavWorld(scenario).description().sets);
}

TEST(NetworkInput, HasTheSameStateFirstWithAndWithoutSensorGeometry) {
  for (uint32_t index = 0; index < 50; ++index) {
    const Scenario scenario = RandomScenario(index);
    const UavWorld world(scenario);
    const UavState start = UavEnvironment(world).state();
    const std::vector<float> plain = InputOf(scenario, start);
    const std::vector<float> more = InputOf(scenario, start, {.sensor_geometry = true});
    ASSERT_EQ(plain.size(), static_cast<size_t>(world.sensors()) + 4);
    ASSERT_EQ(more.size(), 3 * static_cast<size_t>(world.sensors()) + 4);
    EXPECT_TRUE(std::equal(plain.begin(), plain.end(), more.begin()));
    for (int sensor = 0; sensor < world.sensors(); ++sensor) {
      EXPECT_EQ(more[plain.size() + static_cast<size_t>(sensor)],
                world.Covers(start.cell, sensor) ? 1.0f : 0.0f);
    }
  }
}

}  // namespace
}  // namespace fresco
