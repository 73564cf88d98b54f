#include "worlds/uav/scenario.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace fresco {
namespace {

TEST(RandomSensors, LieWithinTheAreaOfTheGridAndFillIt) {
  const std::vector<Sensor> sensors = RandomSensors(20, 10, 25, 2000, 3);
  ASSERT_EQ(sensors.size(), 2000u);
  double largest_x = -1e9, smallest_x = 1e9, largest_y = -1e9, smallest_y = 1e9;
  for (const Sensor& sensor : sensors) {
    EXPECT_EQ(sensor.weight, 1);
    largest_x = std::max(largest_x, sensor.x_m);
    smallest_x = std::min(smallest_x, sensor.x_m);
    largest_y = std::max(largest_y, sensor.y_m);
    smallest_y = std::min(smallest_y, sensor.y_m);
  }
  EXPECT_GE(smallest_x, -12.5);
  EXPECT_GE(smallest_y, -12.5);
  EXPECT_LT(largest_x, 487.5);
  EXPECT_LT(largest_y, 237.5);
  EXPECT_GT(largest_x - smallest_x, 490);
  EXPECT_GT(largest_y - smallest_y, 245);
}

TEST(RandomSensors, AreAFunctionOfTheSeed) {
  const auto first_x = [](uint64_t seed) { return RandomSensors(20, 20, 25, 1, seed)[0].x_m; };
  EXPECT_EQ(first_x(2), first_x(2));
  EXPECT_NE(first_x(2), first_x(3));
}

TEST(RandomSensors, KeepTheirPlaceWhenMoreAreAsked) {
  const std::vector<Sensor> few = RandomSensors(20, 20, 25, 3, 7);
  const std::vector<Sensor> more = RandomSensors(20, 20, 25, 8, 7);
  for (size_t index = 0; index < few.size(); ++index) {
    EXPECT_EQ(few[index].x_m, more[index].x_m);
    EXPECT_EQ(few[index].y_m, more[index].y_m);
  }
}

}  // namespace
}  // namespace fresco
