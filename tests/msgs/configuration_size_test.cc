// A configuration arrives from the network in an actor: sizes that would eat its memory are refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "msgs/experiment.h"
#include "tests/msgs/usage_error.h"

namespace fresco {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string SizeErrorOf(const std::string& text) {
  return UsageErrorOf([&] { Experiment::Parse(text, "FRESCO_RUN"); });
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
  EXPECT_THAT(SizeErrorOf("scenario { " + grid + "random_sensors { count: 11 } }"),
              AllOf(HasSubstr("FRESCO_RUN: scenario.grid: 1000 x 1000 cells and 11 sensors"),
                    HasSubstr("at most 10000000")));
  const Experiment largest = Experiment::Parse("scenario { " + grid + "random_sensors { count: 10 } }", "my");
  EXPECT_EQ(largest.scenario().sensors.size(), 10u);
  EXPECT_THAT(SizeErrorOf("scenario { grid { columns: 1000000000 rows: 1000000000 } }"),
              HasSubstr("scenario.grid.columns: 1000000000 is out of range"));
}

TEST(ConfigurationSize, OfTheNetworkIsBounded) {
  EXPECT_THAT(SizeErrorOf("agent { hidden_layers: [8192, 8192] }"),
              AllOf(HasSubstr("FRESCO_RUN: agent.hidden_layers: 67346452 parameters"),
                    HasSubstr("at most 10000000")));
  EXPECT_EQ(Experiment::Parse("agent { hidden_layers: [3000, 3000] }", "my").network_shape().layers(), 3);
}

TEST(ConfigurationSize, OfTheNetworksDepthIsBounded) {
  const auto deep = [](int layers) { return "agent { " + Repeated("hidden_layers: 1 ", layers) + "}"; };
  EXPECT_THAT(SizeErrorOf(deep(17)), HasSubstr("agent.hidden_layers: 17 layers; allowed: at most 16"));
  EXPECT_EQ(Experiment::Parse(deep(16), "my").network_shape().layers(), 17);
  EXPECT_THAT(SizeErrorOf(deep(100'000)), HasSubstr("agent.hidden_layers: 100000 layers"));
}

// Units of 7 inputs, 8192 hidden and 20 outputs: 8219 a column, so 4866 columns in 40 million.
TEST(ConfigurationSize, OfTheActivationsOfABatchIsBounded) {
  const std::string wide = "hidden_layers: [8192] ";
  EXPECT_THAT(
      SizeErrorOf("agent { " + wide + "batch_size: 65536 }"),
      AllOf(HasSubstr("agent.batch_size: 65536 columns of 8219 units"), HasSubstr("at most 40000000")));
  EXPECT_THAT(SizeErrorOf("agent { hidden_layers: [8192, 1, 8192] } run { environments_per_actor: 4096 }"),
              HasSubstr("run.environments_per_actor: 4096 columns of 16412 units"));
  EXPECT_EQ(Experiment::Parse("agent { " + wide + "batch_size: 4096 }", "my").agent().batch_size(), 4096);
}

TEST(ConfigurationSize, OfMoreSensorsThanThereCanBeIsRefusedWithoutAWorld) {
  EXPECT_THAT(SizeErrorOf("scenario { " + Repeated("sensor {} ", 100'000) + "}"),
              HasSubstr("scenario.sensor"));
}

// The energy margin goes over the wire as a float.
TEST(ConfigurationSize, OfASlotsEnergyIsBounded) {
  EXPECT_THAT(SizeErrorOf("scenario { stop { column: 10 row: 0 } slots: 2 speed_mps: 1e6 slot_s: 1e-4 "
                          "grid { cell_m: 100 } rotor { drag_ratio: 1e6 air_density_kgpm3: 1e6 solidity: 1e6 "
                          "disk_area_m2: 1e6 } radio { update_bits: 1 } }"),
              HasSubstr("scenario.rotor: "));
}

}  // namespace
}  // namespace fresco
