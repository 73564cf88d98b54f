// What a configuration's errors say: the origin, the field, its value and what is allowed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "msgs/experiment.h"
#include "tests/msgs/usage_error.h"

namespace fresco {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

std::string ErrorOf(const std::string& text) {
  const std::string error = UsageErrorOf([&] { Experiment::Parse(text, "my.textproto"); });
  EXPECT_THAT(error, StartsWith("my.textproto:"));
  return error;
}

TEST(ConfigurationError, NamesLineAndColumnOfAnUnknownField) {
  EXPECT_THAT(
      ErrorOf("agent {\n  bach_size: 3\n}"),
      AllOf(StartsWith("my.textproto:2:"), HasSubstr("bach_size"), HasSubstr("did you mean batch_size?")));
  EXPECT_THAT(ErrorOf("scenary {}"), HasSubstr("did you mean scenario?"));
  EXPECT_THAT(ErrorOf("agent { " + std::string(1'000'000, 'x') + ": 1 }"), HasSubstr("xxx"));
  EXPECT_THAT(ErrorOf("agent {\n"), StartsWith("my.textproto:2:1: "));
  EXPECT_THAT(ErrorOf("schedule { seed: \"a\" }"), StartsWith("my.textproto:1:18: "));
}

TEST(ConfigurationError, NamesAFieldGivenTwice) {
  EXPECT_THAT(ErrorOf("schedule { seed: 1 seed: 2 }"),
              AllOf(StartsWith("my.textproto:1:"), HasSubstr("seed")));
}

TEST(ConfigurationError, NamesFieldValueAndRange) {
  EXPECT_THAT(ErrorOf("agent { discount: 1.5 }"),
              HasSubstr("agent.discount: 1.5 is out of range; allowed: 0 to 1"));
  EXPECT_THAT(ErrorOf("agent { hidden_layers: [8, 0] }"),
              HasSubstr("agent.hidden_layers[1]: 0 is out of range; allowed: 1 to 8192"));
  EXPECT_THAT(ErrorOf("agent { linear { initial: -1 } }"),
              HasSubstr("agent.linear.initial: -1 is out of range"));
  EXPECT_THAT(ErrorOf("schedule { ladder { rungs: 1 } }"),
              HasSubstr("schedule.ladder.rungs: 1 is out of range; allowed: 2 to 10000"));
  EXPECT_THAT(ErrorOf("schedule { episodes: 0 }"), HasSubstr("schedule.episodes: 0 is out of range"));
  EXPECT_THAT(ErrorOf("run { actors: 1025 }"),
              HasSubstr("run.actors: 1025 is out of range; allowed: 0 to 1024"));
  EXPECT_THAT(ErrorOf("scenario { grid { columns: 0 } }"),
              HasSubstr("scenario.grid.columns: 0 is out of range"));
  EXPECT_THAT(ErrorOf("scenario { start { row: 20 } }"),
              HasSubstr("scenario.start.row: 20 is out of range; allowed: 0 to 19"));
  EXPECT_THAT(ErrorOf("scenario { sensor {} sensor { weight: -1 } }"),
              HasSubstr("scenario.sensor[1].weight: -1 is out of range"));
  EXPECT_THAT(ErrorOf("scenario { maximum_aoi: 0 }"), HasSubstr("scenario.maximum_aoi: 0 is out of range"));
}

TEST(ConfigurationError, NamesTheRangeOfEveryValueOfTheScenario) {
  struct Case {
    std::string path;
    std::string value;
    std::string allowed;
  };
  const Case cases[] = {
      {"slots", "0", "2 to 10000"},
      {"slots", "10001", "2 to 10000"},
      {"grid.columns", "0", "1 to 1000"},
      {"grid.rows", "1001", "1 to 1000"},
      {"grid.cell_m", "-25", "1e-06 to 1000000"},
      {"slot_s", "nan", "1e-06 to 1000000"},
      {"coverage_radius_m", "-1", "0 to 1000000"},
      {"initial_energy_j", "0", "1e-06 to 1000000000000"},
      {"radio.bandwidth_hz", "0", "1 to 1000000000000"},
      {"radio.update_bits", "0", "1 to 1000000000000000"},
      {"radio.noise_dbm", "101", "-300 to 100"},
      {"radio.gain_at_1m_db", "-301", "-300 to 100"},
      {"radio.altitude_m", "-1", "0 to 1000000"},
      {"rotor.blade_profile_power_w", "-1", "0 to 1000000"},
      {"rotor.induced_power_w", "-1", "0 to 1000000"},
      {"rotor.tip_speed_mps", "0", "1e-06 to 1000000"},
      {"rotor.induced_velocity_mps", "0", "1e-06 to 1000000"},
      {"rotor.drag_ratio", "nan", "0 to 1000000"},
      {"rotor.air_density_kgpm3", "-1", "0 to 1000000"},
      {"rotor.solidity", "-1", "0 to 1000000"},
      {"rotor.disk_area_m2", "-1", "0 to 1000000"},
      {"speed_mps", "0", "1e-06 to 1000000"},
      {"reward.k1", "-1", "0 to 1000000"},
      {"reward.k2", "nan", "0 to 1000000"},
      {"reward.k3", "-2", "0 to 1000000"},
      {"maximum_aoi", "0", "1 to 10000"},
      {"random_sensors.count", "251", "1 to 250"},
  };
  for (const Case& each : cases) {
    const Settings settings = {{"scenario." + each.path, each.value}};
    EXPECT_EQ(UsageErrorOf([&] { Experiment::Parse("", "my", settings); }),
              "my: scenario." + each.path + ": " + each.value + " is out of range; allowed: " + each.allowed);
  }
  EXPECT_THAT(ErrorOf("scenario { sensor { x_m: inf } }"),
              HasSubstr("scenario.sensor[0].x_m: inf is out of range; allowed: -1000000 to 1000000"));
  EXPECT_THAT(ErrorOf("scenario { sensor { y_m: nan } }"), HasSubstr("scenario.sensor[0].y_m: nan"));
}

TEST(ConfigurationError, TakesNaNAndInfinityForOutOfRange) {
  EXPECT_THAT(ErrorOf("agent { discount: nan }"),
              HasSubstr("agent.discount: nan is out of range; allowed: 0 to 1"));
  EXPECT_THAT(ErrorOf("scenario { slot_s: nan }"), HasSubstr("scenario.slot_s: nan is out of range"));
  EXPECT_THAT(ErrorOf("scenario { coverage_radius_m: nan }"), HasSubstr("scenario.coverage_radius_m: nan"));
  EXPECT_THAT(ErrorOf("scenario { initial_energy_j: inf }"), HasSubstr("scenario.initial_energy_j: inf"));
  EXPECT_THAT(ErrorOf("scenario { transmit_power_w: nan }"), HasSubstr("scenario.transmit_power_w: nan"));
}

TEST(ConfigurationError, NamesBothOfTwoWaysToPlaceSensors) {
  EXPECT_THAT(ErrorOf("scenario { sensor {} random_sensors {} }"),
              AllOf(HasSubstr("scenario.sensor"), HasSubstr("scenario.random_sensors")));
}

TEST(ConfigurationError, NamesBothOfTwoAlternativesGiven) {
  EXPECT_THAT(ErrorOf("scenario { coverage_radius_m: 100 transmit_power_w: 0.1 }"),
              AllOf(HasSubstr("coverage_radius_m"), HasSubstr("transmit_power_w")));
  EXPECT_THAT(ErrorOf("agent { linear {} exponential {} }"),
              AllOf(HasSubstr("linear"), HasSubstr("exponential")));
  EXPECT_THAT(ErrorOf("schedule { ladder {} linear {} }"), AllOf(HasSubstr("ladder"), HasSubstr("linear")));
}

TEST(ConfigurationError, SaysThatTheStopIsOutOfReach) {
  EXPECT_THAT(ErrorOf("scenario { slots: 19 }"),
              AllOf(HasSubstr("scenario.slots: 19"), HasSubstr("scenario.stop"), HasSubstr("19 moves")));
  EXPECT_EQ(Experiment::Parse("scenario { slots: 20 }", "my").scenario().slots, 20);
  EXPECT_THAT(ErrorOf("scenario { initial_energy_j: 1000 }"), HasSubstr("scenario.initial_energy_j: 1000"));
}

TEST(ConfigurationError, SaysThatThePowerIsTooSmall) {
  EXPECT_THAT(ErrorOf("scenario { transmit_power_w: 0.001 }"), HasSubstr("scenario.transmit_power_w: 0.001"));
}

TEST(ConfigurationError, AllowsAsManySensorsAsFitAFrame) {
  std::string sensors;
  for (int i = 0; i < 250; ++i) {
    sensors += "sensor { x_m: 1 }\n";
  }
  EXPECT_EQ(Experiment::Parse("scenario { " + sensors + "}", "my").scenario().sensors.size(), 250u);
  EXPECT_THAT(ErrorOf("scenario { " + sensors + "sensor {} }"),
              AllOf(HasSubstr("scenario.sensor: a count of 251"), HasSubstr("1 to 250")));
  EXPECT_THAT(ErrorOf("scenario { random_sensors { count: 251 } }"),
              HasSubstr("scenario.random_sensors.count: 251 is out of range; allowed: 1 to 250"));
}

TEST(ConfigurationError, NamesTheChannelPrefix) {
  EXPECT_THAT(ErrorOf("run { channel_prefix: \"A.*\" }"), HasSubstr("run.channel_prefix: \"A.*\""));
}

}  // namespace
}  // namespace fresco
