// What a viewer gets to know of a field.
#include "msgs/flight_messages.h"

#include <gtest/gtest.h>

#include "tests/msgs/message_samples.h"
#include "tests/worlds/table_one.h"

namespace fresco {
namespace {

/// Sensor n stands at (n, 2 n) metres and weighs 3 n + 1.
Scenario FieldOf(int sensors) {
  Scenario scenario = TableOne();
  for (int n = 0; n < sensors; ++n) {
    scenario.sensors.push_back({1.0 * n, 2.0 * n, 3.0 * n + 1});
  }
  return scenario;
}

TEST(ScenarioMessages, CarryEverySensorOnceAndInOrder) {
  for (const auto& [sensors, expected_messages] :
       {std::pair{1, 1}, {3, 1}, {48, 1}, {49, 2}, {96, 2}, {97, 3}, {250, 6}}) {
    const std::vector<scenario_t> messages = ScenarioMessages(FieldOf(sensors));
    EXPECT_EQ(messages.size(), static_cast<size_t>(expected_messages));
    int next = 0;
    for (const scenario_t& message : messages) {
      EXPECT_EQ(message.total_sensors, sensors);
      EXPECT_EQ(message.first_sensor, next);
      scenario_t decoded{};
      ASSERT_TRUE(Decode(Encoded(message), decoded));
      for (size_t i = 0; i < decoded.x_m.size(); ++i, ++next) {
        EXPECT_EQ(decoded.x_m[i], next);
        EXPECT_EQ(decoded.y_m[i], 2 * next);
        EXPECT_EQ(decoded.weight[i], 3 * next + 1);
      }
    }
    EXPECT_EQ(next, sensors);
  }
}

TEST(ScenarioMessages, TellTheFieldAndTheFlight) {
  Scenario scenario = FieldOf(2);
  scenario.columns = 7;
  scenario.rows = 9;
  scenario.cell_m = 12.5;
  scenario.slots = 33;
  scenario.slot_s = 0.5;
  scenario.start = {1, 2};
  scenario.stop = {3, 4};
  scenario.coverage_radius_m = 60;
  scenario.initial_energy_j = 5000;
  const scenario_t uncapped = ScenarioMessages(scenario).at(0);
  EXPECT_EQ(uncapped.columns, 7);
  EXPECT_EQ(uncapped.rows, 9);
  EXPECT_EQ(uncapped.cell_m, 12.5);
  EXPECT_EQ(uncapped.slots, 33);
  EXPECT_EQ(uncapped.slot_s, 0.5);
  EXPECT_EQ(uncapped.start_column, 1);
  EXPECT_EQ(uncapped.start_row, 2);
  EXPECT_EQ(uncapped.stop_column, 3);
  EXPECT_EQ(uncapped.stop_row, 4);
  EXPECT_EQ(uncapped.coverage_radius_m, 60);
  EXPECT_EQ(uncapped.initial_energy_j, 5000);
  EXPECT_EQ(uncapped.maximum_aoi, 0);
  scenario.maximum_aoi = 20;
  EXPECT_EQ(ScenarioMessages(scenario).at(0).maximum_aoi, 20);
}

}  // namespace
}  // namespace fresco
