// What UavWorld refuses, and in which words; sensors at random places.
#include "worlds/uav/uav_world.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>

#include "tests/support/error_of.h"
#include "tests/worlds/test_scenarios.h"

namespace fresco {
namespace {

using testing::HasSubstr;

void MakeWorld(const std::function<void(Scenario*)>& change) {
  Scenario scenario = TableOneScenario();
  change(&scenario);
  UavWorld world(scenario);
}

std::string Refusal(const std::function<void(Scenario*)>& change) {
  return ErrorOf([&] { MakeWorld(change); });
}

TEST(ScenarioCheck, AcceptsTableOne) {
  EXPECT_NO_THROW(MakeWorld([](Scenario*) {}));
}

TEST(ScenarioCheck, WantsStartAndStopOnTheGrid) {
  EXPECT_EQ(Refusal([](Scenario* scenario) {
              scenario->start = {20, 0};
            }),
            "scenario.start.column: 20 is out of range; allowed: 0 to 19");
  EXPECT_EQ(Refusal([](Scenario* scenario) {
              scenario->stop = {3, -1};
            }),
            "scenario.stop.row: -1 is out of range; allowed: 0 to 19");
}

TEST(ScenarioCheck, WantsOneToAsManySensorsAsFitAFrame) {
  EXPECT_EQ(Refusal([](Scenario* scenario) { scenario->sensors.clear(); }),
            "scenario.sensor: a count of 0 is out of range; allowed: 1 to 250");
  EXPECT_EQ(Refusal([](Scenario* scenario) { scenario->sensors.resize(251); }),
            "scenario.sensor: a count of 251 is out of range; allowed: 1 to 250");
}

TEST(ScenarioCheck, WantsAPositiveSumOfWeights) {
  const auto weightless = [](Scenario* scenario) {
    for (Sensor& sensor : scenario->sensors) {
      sensor.weight = 0;
    }
  };
  EXPECT_THAT(Refusal(weightless), HasSubstr("scenario.sensor: the weights sum to 0"));
  EXPECT_NO_THROW(MakeWorld([](Scenario* scenario) { scenario->sensors[0].weight = 0; }));
}

TEST(ScenarioCheck, WantsASpeedOfOneCellASlot) {
  const std::string refusal = Refusal([](Scenario* scenario) { scenario->speed_mps = 20; });
  EXPECT_THAT(refusal, HasSubstr("scenario.speed_mps: 20"));
  EXPECT_THAT(refusal, HasSubstr("scenario.slot_s: 1"));
  EXPECT_THAT(refusal, HasSubstr("scenario.grid.cell_m is 25"));
  const auto tenths = [](Scenario* scenario) {
    scenario->speed_mps = 3;
    scenario->slot_s = 0.1;
    scenario->cell_m = 0.3;  // 3 * 0.1 is not 0.3 in double
    scenario->radio.update_bits = 1e5;
  };
  EXPECT_NO_THROW(MakeWorld(tenths));
}

TEST(ScenarioCheck, SaysByHowMuchTheSlotsFallShort) {
  const std::string refusal = Refusal([](Scenario* scenario) { scenario->slots = 15; });
  EXPECT_EQ(refusal,
            "scenario.slots: 15 is out of range: scenario.stop is 19 moves from scenario.start and there is "
            "time for 14, 5 too few; allowed: at least 20");
  EXPECT_NO_THROW(MakeWorld([](Scenario* scenario) { scenario->slots = 20; }));
}

// 70 slots, 19 cells: 69 * 112.8758628 J = 7788.43 J, all flown.
TEST(ScenarioCheck, SaysByHowMuchTheEnergyFallsShort) {
  const std::string refusal = Refusal([](Scenario* scenario) { scenario->initial_energy_j = 7000; });
  EXPECT_THAT(refusal, HasSubstr("scenario.initial_energy_j: 7000 is out of range"));
  EXPECT_THAT(refusal, HasSubstr("takes 7788.43 J, 788.435 J more"));
  EXPECT_NO_THROW(MakeWorld([](Scenario* scenario) { scenario->initial_energy_j = 7789; }));
}

// 69 slots leave an odd slack of 49, which takes one hover: 67 * 112.876 + 219.82 = 7782.50 J.
TEST(ScenarioCheck, CountsTheHoverOfAnOddSlack) {
  const auto odd = [](double energy_j) {
    return [=](Scenario* scenario) {
      scenario->slots = 69;
      scenario->initial_energy_j = energy_j;
    };
  };
  EXPECT_THAT(Refusal(odd(7750)), HasSubstr("scenario.initial_energy_j: 7750 is out of range"));
  EXPECT_NO_THROW(MakeWorld(odd(7783)));
}

TEST(ScenarioCheck, RefusesAnUpdateThatNoSignalCouldCarry) {
  EXPECT_THAT(Refusal([](Scenario* scenario) { scenario->radio.update_bits = 1e9; }),
              HasSubstr("bit/s/Hz; allowed: at most 100"));
}

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
