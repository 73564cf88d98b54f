// What World refuses, and in which words.
#include "worlds/uav/scenario_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "core/error.h"
#include "tests/worlds/test_scenarios.h"
#include "worlds/uav/world.h"

namespace fresco {
namespace {

using testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string Refusal(const std::function<void(Scenario*)>& change) {
  Scenario scenario = TableOneScenario();
  change(&scenario);
  try {
    World world(scenario);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kUsage);
    return error.what();
  }
  return "accepted";
}

TEST(ScenarioCheck, AcceptsTableOne) {
  EXPECT_EQ(Refusal([](Scenario*) {}), "accepted");
}

TEST(ScenarioCheck, NamesFieldValueAndRange) {
  struct Case {
    std::function<void(Scenario*)> change;
    std::string refusal;
  };
  const Case cases[] = {
      {[](Scenario* s) { s->slots = 0; }, "scenario.slots: 0 is out of range; allowed: 2 to 10000"},
      {[](Scenario* s) { s->slots = 10001; }, "scenario.slots: 10001 is out of range; allowed: 2 to 10000"},
      {[](Scenario* s) { s->columns = 0; }, "scenario.grid.columns: 0 is out of range; allowed: 1 to 1000"},
      {[](Scenario* s) { s->rows = 1001; }, "scenario.grid.rows: 1001 is out of range; allowed: 1 to 1000"},
      {[](Scenario* s) { s->cell_m = -25; },
       "scenario.grid.cell_m: -25 is out of range; allowed: 1e-06 to 1000000"},
      {[](Scenario* s) { s->slot_s = kNan; },
       "scenario.slot_s: nan is out of range; allowed: 1e-06 to 1000000"},
      {[](Scenario* s) {
         s->start = {20, 0};
       },
       "scenario.start.column: 20 is out of range; allowed: 0 to 19"},
      {[](Scenario* s) {
         s->stop = {3, -1};
       },
       "scenario.stop.row: -1 is out of range; allowed: 0 to 19"},
      {[](Scenario* s) { s->sensors.clear(); },
       "scenario.sensor: a count of 0 is out of range; allowed: 1 to 250"},
      {[](Scenario* s) { s->sensors.resize(251); },
       "scenario.sensor: a count of 251 is out of range; allowed: 1 to 250"},
      {[](Scenario* s) { s->sensors[2].weight = -1; },
       "scenario.sensor[2].weight: -1 is out of range; allowed: 0 to 1000000"},
      {[](Scenario* s) { s->sensors[1].x_m = kInfinity; },
       "scenario.sensor[1].x_m: inf is out of range; allowed: -1000000 to 1000000"},
      {[](Scenario* s) { s->sensors[0].y_m = kNan; },
       "scenario.sensor[0].y_m: nan is out of range; allowed: -1000000 to 1000000"},
      {[](Scenario* s) { s->coverage_radius_m = -1; },
       "scenario.coverage_radius_m: -1 is out of range; allowed: 0 to 1000000"},
      {[](Scenario* s) { s->initial_energy_j = 0; },
       "scenario.initial_energy_j: 0 is out of range; allowed: 1e-06 to 1000000000000"},
      {[](Scenario* s) { s->radio.bandwidth_hz = 0; },
       "scenario.radio.bandwidth_hz: 0 is out of range; allowed: 1 to 1000000000000"},
      {[](Scenario* s) { s->radio.update_bits = 0; },
       "scenario.radio.update_bits: 0 is out of range; allowed: 1 to 1000000000000000"},
      {[](Scenario* s) { s->radio.noise_dbm = 101; },
       "scenario.radio.noise_dbm: 101 is out of range; allowed: -300 to 100"},
      {[](Scenario* s) { s->radio.gain_at_1m_db = -301; },
       "scenario.radio.gain_at_1m_db: -301 is out of range; allowed: -300 to 100"},
      {[](Scenario* s) { s->radio.altitude_m = -1; },
       "scenario.radio.altitude_m: -1 is out of range; allowed: 0 to 1000000"},
      {[](Scenario* s) { s->rotor.blade_profile_power_w = -1; },
       "scenario.rotor.blade_profile_power_w: -1 is out of range; allowed: 0 to 1000000"},
      {[](Scenario* s) { s->rotor.induced_power_w = -1; },
       "scenario.rotor.induced_power_w: -1 is out of range; allowed: 0 to 1000000"},
      {[](Scenario* s) { s->rotor.tip_speed_mps = 0; },
       "scenario.rotor.tip_speed_mps: 0 is out of range; allowed: 1e-06 to 1000000"},
      {[](Scenario* s) { s->rotor.induced_velocity_mps = 0; },
       "scenario.rotor.induced_velocity_mps: 0 is out of range; allowed: 1e-06 to 1000000"},
      {[](Scenario* s) { s->rotor.drag_ratio = kNan; },
       "scenario.rotor.drag_ratio: nan is out of range; allowed: 0 to 1000000"},
      {[](Scenario* s) { s->rotor.air_density_kgpm3 = -1; },
       "scenario.rotor.air_density_kgpm3: -1 is out of range; allowed: 0 to 1000000"},
      {[](Scenario* s) { s->rotor.solidity = -1; },
       "scenario.rotor.solidity: -1 is out of range; allowed: 0 to 1000000"},
      {[](Scenario* s) { s->rotor.disk_area_m2 = -1; },
       "scenario.rotor.disk_area_m2: -1 is out of range; allowed: 0 to 1000000"},
      {[](Scenario* s) { s->speed_mps = 0; },
       "scenario.speed_mps: 0 is out of range; allowed: 1e-06 to 1000000"},
      {[](Scenario* s) { s->reward.k1 = -1; },
       "scenario.reward.k1: -1 is out of range; allowed: 0 to 1000000"},
      {[](Scenario* s) { s->reward.k2 = kNan; },
       "scenario.reward.k2: nan is out of range; allowed: 0 to 1000000"},
      {[](Scenario* s) { s->reward.k3 = -2; },
       "scenario.reward.k3: -2 is out of range; allowed: 0 to 1000000"},
      {[](Scenario* s) { s->maximum_aoi = 0; },
       "scenario.maximum_aoi: 0 is out of range; allowed: 1 to 10000"},
  };
  for (const Case& each : cases) {
    EXPECT_EQ(Refusal(each.change), each.refusal);
  }
}

TEST(ScenarioCheck, WantsAPositiveSumOfWeights) {
  const auto weightless = [](Scenario* scenario) {
    for (Sensor& sensor : scenario->sensors) {
      sensor.weight = 0;
    }
  };
  EXPECT_THAT(Refusal(weightless), HasSubstr("scenario.sensor: the weights sum to 0"));
  EXPECT_EQ(Refusal([](Scenario* scenario) { scenario->sensors[0].weight = 0; }), "accepted");
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
  EXPECT_EQ(Refusal(tenths), "accepted");
}

TEST(ScenarioCheck, SaysByHowMuchTheSlotsFallShort) {
  const std::string refusal = Refusal([](Scenario* scenario) { scenario->slots = 15; });
  EXPECT_EQ(refusal,
            "scenario.slots: 15 is out of range: scenario.stop is 19 moves from scenario.start and there is "
            "time for 14, 5 too few; allowed: 20 to 10000");
  EXPECT_EQ(Refusal([](Scenario* scenario) { scenario->slots = 20; }), "accepted");
}

// 70 slots, 19 cells: 69 * 112.8758628 J = 7788.43 J, all flown.
TEST(ScenarioCheck, SaysByHowMuchTheEnergyFallsShort) {
  const std::string refusal = Refusal([](Scenario* scenario) { scenario->initial_energy_j = 7000; });
  EXPECT_THAT(refusal, HasSubstr("scenario.initial_energy_j: 7000 is out of range"));
  EXPECT_THAT(refusal, HasSubstr("takes 7788.43 J, 788.435 J more"));
  EXPECT_EQ(Refusal([](Scenario* scenario) { scenario->initial_energy_j = 7789; }), "accepted");
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
  EXPECT_EQ(Refusal(odd(7783)), "accepted");
}

TEST(ScenarioCheck, RefusesAnUpdateThatNoSignalCouldCarry) {
  EXPECT_THAT(Refusal([](Scenario* scenario) { scenario->radio.update_bits = 1e9; }),
              HasSubstr("bit/s/Hz; allowed: at most 100"));
}

}  // namespace
}  // namespace fresco
