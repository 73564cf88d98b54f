// What a configuration's errors say: the origin, the field, its value and what is allowed. A configuration
// also arrives from the network in an actor: sizes that would eat its memory are refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "msgs/experiment.h"
#include "tests/msgs/uav_world_of.h"
#include "tests/support/error_of.h"

namespace fresco {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

std::string Refusal(const std::string& text) {
  const std::string error = ErrorOf([&] { Experiment::Parse(text, "my.textproto"); });
  EXPECT_THAT(error, StartsWith("my.textproto:"));
  return error;
}

TEST(ConfigurationError, NamesLineAndColumnOfAnUnknownField) {
  EXPECT_THAT(
      Refusal("agent {\n  bach_size: 3\n}"),
      AllOf(StartsWith("my.textproto:2:"), HasSubstr("bach_size"), HasSubstr("did you mean batch_size?")));
  EXPECT_THAT(Refusal("scenary {}"), HasSubstr("did you mean scenario?"));
  EXPECT_THAT(Refusal("agent { " + std::string(1'000'000, 'x') + ": 1 }"), HasSubstr("xxx"));
  EXPECT_THAT(Refusal("agent {\n"), StartsWith("my.textproto:2:1: "));
  EXPECT_THAT(Refusal("schedule { seed: \"a\" }"), StartsWith("my.textproto:1:18: "));
}

TEST(ConfigurationError, NamesAFieldGivenTwice) {
  EXPECT_THAT(Refusal("schedule { seed: 1 seed: 2 }"),
              AllOf(StartsWith("my.textproto:1:"), HasSubstr("seed")));
}

TEST(ConfigurationError, NamesFieldValueAndRange) {
  EXPECT_THAT(Refusal("agent { discount: 1.5 }"),
              HasSubstr("agent.discount: 1.5 is out of range; allowed: 0 to 1"));
  EXPECT_THAT(Refusal("agent { hidden_layers: [8, 0] }"),
              HasSubstr("agent.hidden_layers[1]: 0 is out of range; allowed: 1 to 8192"));
  EXPECT_THAT(Refusal("agent { linear { initial: -1 } }"),
              HasSubstr("agent.linear.initial: -1 is out of range"));
  EXPECT_THAT(Refusal("schedule { ladder { rungs: 1 } }"),
              HasSubstr("schedule.ladder.rungs: 1 is out of range; allowed: 2 to 10000"));
  EXPECT_THAT(Refusal("schedule { episodes: 0 }"), HasSubstr("schedule.episodes: 0 is out of range"));
  EXPECT_THAT(Refusal("run { actors: 1025 }"),
              HasSubstr("run.actors: 1025 is out of range; allowed: 0 to 1024"));
  EXPECT_THAT(Refusal("scenario { grid { columns: 0 } }"),
              HasSubstr("scenario.grid.columns: 0 is out of range"));
  EXPECT_THAT(Refusal("scenario { start { row: 20 } }"),
              HasSubstr("scenario.start.row: 20 is out of range; allowed: 0 to 19"));
  EXPECT_THAT(Refusal("scenario { sensor {} sensor { weight: -1 } }"),
              HasSubstr("scenario.sensor[1].weight: -1 is out of range"));
  EXPECT_THAT(Refusal("scenario { maximum_aoi: 0 }"), HasSubstr("scenario.maximum_aoi: 0 is out of range"));
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
    EXPECT_EQ(ErrorOf([&] { Experiment::Parse("", "my", settings); }),
              "my: scenario." + each.path + ": " + each.value + " is out of range; allowed: " + each.allowed);
  }
  EXPECT_THAT(Refusal("scenario { sensor { x_m: inf } }"),
              HasSubstr("scenario.sensor[0].x_m: inf is out of range; allowed: -1000000 to 1000000"));
  EXPECT_THAT(Refusal("scenario { sensor { y_m: nan } }"), HasSubstr("scenario.sensor[0].y_m: nan"));
}

TEST(ConfigurationError, TakesNaNAndInfinityForOutOfRange) {
  EXPECT_THAT(Refusal("agent { discount: nan }"),
              HasSubstr("agent.discount: nan is out of range; allowed: 0 to 1"));
  EXPECT_THAT(Refusal("scenario { coverage_radius_m: nan }"), HasSubstr("scenario.coverage_radius_m: nan"));
  EXPECT_THAT(Refusal("scenario { initial_energy_j: inf }"), HasSubstr("scenario.initial_energy_j: inf"));
  EXPECT_THAT(Refusal("scenario { transmit_power_w: nan }"), HasSubstr("scenario.transmit_power_w: nan"));
}

TEST(ConfigurationError, NamesBothOfTwoWaysToPlaceSensors) {
  EXPECT_THAT(Refusal("scenario { sensor {} random_sensors {} }"),
              AllOf(HasSubstr("scenario.sensor"), HasSubstr("scenario.random_sensors")));
}

TEST(ConfigurationError, NamesBothOfTwoAlternativesGiven) {
  EXPECT_THAT(Refusal("scenario { coverage_radius_m: 100 transmit_power_w: 0.1 }"),
              AllOf(HasSubstr("coverage_radius_m"), HasSubstr("transmit_power_w")));
  EXPECT_THAT(Refusal("agent { linear {} exponential {} }"),
              AllOf(HasSubstr("linear"), HasSubstr("exponential")));
  EXPECT_THAT(Refusal("schedule { ladder {} linear {} }"), AllOf(HasSubstr("ladder"), HasSubstr("linear")));
}

TEST(ConfigurationError, SaysThatTheStopIsOutOfReach) {
  EXPECT_THAT(Refusal("scenario { slots: 19 }"),
              AllOf(HasSubstr("scenario.slots: 19"), HasSubstr("scenario.stop"), HasSubstr("19 moves")));
  EXPECT_EQ(UavWorldOf(Experiment::Parse("scenario { slots: 20 }", "my")).scenario().slots, 20);
  EXPECT_THAT(Refusal("scenario { initial_energy_j: 1000 }"), HasSubstr("scenario.initial_energy_j: 1000"));
}

TEST(ConfigurationError, SaysThatThePowerIsTooSmall) {
  EXPECT_THAT(Refusal("scenario { transmit_power_w: 0.001 }"), HasSubstr("scenario.transmit_power_w: 0.001"));
}

TEST(ConfigurationError, AllowsAsManySensorsAsFitAFrame) {
  std::string sensors;
  for (int i = 0; i < 250; ++i) {
    sensors += "sensor { x_m: 1 }\n";
  }
  EXPECT_EQ(UavWorldOf(Experiment::Parse("scenario { " + sensors + "}", "my")).scenario().sensors.size(),
            250u);
  EXPECT_THAT(Refusal("scenario { " + sensors + "sensor {} }"),
              AllOf(HasSubstr("scenario.sensor: a count of 251"), HasSubstr("1 to 250")));
  EXPECT_THAT(Refusal("scenario { random_sensors { count: 251 } }"),
              HasSubstr("scenario.random_sensors.count: 251 is out of range; allowed: 1 to 250"));
}

TEST(ConfigurationError, NamesTheChannelPrefix) {
  EXPECT_THAT(Refusal("run { channel_prefix: \"A.*\" }"), HasSubstr("run.channel_prefix: \"A.*\""));
}

std::string Repeated(const std::string& text, int count) {
  std::string repeated;
  for (int i = 0; i < count; ++i) {
    repeated += text;
  }
  return repeated;
}

TEST(ConfigurationSize, OfTheGridTimesTheSensorsIsBounded) {
  const std::string grid = "grid { columns: 1000 rows: 1000 } ";
  EXPECT_THAT(Refusal("scenario { " + grid + "random_sensors { count: 11 } }"),
              AllOf(HasSubstr("my.textproto: scenario.grid: 1000 x 1000 cells and 11 sensors"),
                    HasSubstr("at most 10000000")));
  const Experiment largest = Experiment::Parse("scenario { " + grid + "random_sensors { count: 10 } }", "my");
  EXPECT_EQ(UavWorldOf(largest).scenario().sensors.size(), 10u);
  EXPECT_THAT(Refusal("scenario { grid { columns: 1000000000 rows: 1000000000 } }"),
              HasSubstr("scenario.grid.columns: 1000000000 is out of range"));
}

TEST(ConfigurationSize, OfTheNetworkIsBounded) {
  EXPECT_THAT(Refusal("agent { hidden_layers: [8192, 8192] }"),
              AllOf(HasSubstr("my.textproto: agent.hidden_layers: 67346452 parameters"),
                    HasSubstr("at most 10000000")));
  EXPECT_EQ(Experiment::Parse("agent { hidden_layers: [3000, 3000] }", "my").network()->layer_sizes().size(),
            4u);
}

TEST(ConfigurationSize, OfTheNetworksDepthIsBounded) {
  const auto deep = [](int layers) { return "agent { " + Repeated("hidden_layers: 1 ", layers) + "}"; };
  EXPECT_THAT(Refusal(deep(17)), HasSubstr("agent.hidden_layers: 17 layers; allowed: at most 16"));
  EXPECT_EQ(Experiment::Parse(deep(16), "my").network()->layer_sizes().size(), 18u);
  EXPECT_THAT(Refusal(deep(100'000)), HasSubstr("agent.hidden_layers: 100000 layers"));
}

// Units of 7 inputs, 8192 hidden and 20 outputs: 8219 a column, so 4866 columns in 40 million.
TEST(ConfigurationSize, OfTheActivationsOfABatchIsBounded) {
  const std::string wide = "hidden_layers: [8192] ";
  EXPECT_THAT(
      Refusal("agent { " + wide + "batch_size: 65536 }"),
      AllOf(HasSubstr("agent.batch_size: 65536 columns of 8219 units"), HasSubstr("at most 40000000")));
  EXPECT_THAT(Refusal("agent { hidden_layers: [8192, 1, 8192] } run { environments_per_actor: 4096 }"),
              HasSubstr("run.environments_per_actor: 4096 columns of 16412 units"));
  EXPECT_EQ(Experiment::Parse("agent { " + wide + "batch_size: 4096 }", "my").agent().batch_size(), 4096);
}

TEST(ConfigurationSize, OfMoreSensorsThanThereCanBeIsRefusedWithoutAWorld) {
  EXPECT_THAT(Refusal("scenario { " + Repeated("sensor {} ", 100'000) + "}"), HasSubstr("scenario.sensor"));
}

// The energy margin goes over the wire as a float.
TEST(ConfigurationSize, OfASlotsEnergyIsBounded) {
  EXPECT_THAT(Refusal("scenario { stop { column: 10 row: 0 } slots: 2 speed_mps: 1e6 slot_s: 1e-4 "
                      "grid { cell_m: 100 } rotor { drag_ratio: 1e6 air_density_kgpm3: 1e6 solidity: 1e6 "
                      "disk_area_m2: 1e6 } radio { update_bits: 1 } }"),
              HasSubstr("scenario.rotor: "));
}

}  // namespace
}  // namespace fresco
