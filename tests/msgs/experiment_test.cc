#include "msgs/experiment.h"

#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

namespace fresco {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using testing::ElementsAre;

Experiment Parse(const std::string& text, const Settings& settings = {}) {
  return Experiment::Parse(text, "test", settings);
}

TEST(Experiment, OmittedFieldsAreTableOne) {
  const Scenario scenario = Parse("").scenario();
  EXPECT_EQ(scenario.radio.bandwidth_hz, 1e6);
  EXPECT_EQ(scenario.radio.update_bits, 5e6);
  EXPECT_EQ(scenario.radio.noise_dbm, -100);
  EXPECT_EQ(scenario.radio.gain_at_1m_db, -60);
  EXPECT_EQ(scenario.radio.altitude_m, 120);
  EXPECT_EQ(scenario.slots, 70);
  EXPECT_EQ(scenario.speed_mps, 25);
  EXPECT_EQ(scenario.initial_energy_j, 2.2e4);
  EXPECT_EQ(scenario.rotor.air_density_kgpm3, 1.225);
  EXPECT_EQ(scenario.rotor.tip_speed_mps, 120);
  EXPECT_EQ(scenario.rotor.blade_profile_power_w, 99.66);
  EXPECT_EQ(scenario.rotor.induced_power_w, 120.16);
  EXPECT_EQ(scenario.rotor.drag_ratio, 0.48);
  EXPECT_EQ(scenario.rotor.solidity, 0.0001);
  EXPECT_EQ(scenario.rotor.disk_area_m2, 0.5);
  EXPECT_EQ(scenario.rotor.induced_velocity_mps, 0.002);
}

TEST(Experiment, OmittedFieldsAreTheFieldOfSectionFour) {
  const Scenario scenario = Parse("").scenario();
  EXPECT_EQ(scenario.columns, 20);
  EXPECT_EQ(scenario.rows, 20);
  EXPECT_EQ(scenario.cell_m, 25);
  EXPECT_EQ(scenario.slot_s, 1);
  EXPECT_EQ(scenario.start, (Cell{10, 0}));
  EXPECT_EQ(scenario.stop, (Cell{10, 19}));
  EXPECT_EQ(scenario.coverage_radius_m, 100);
  EXPECT_EQ(scenario.sensors.size(), 3u);
  EXPECT_FALSE(scenario.maximum_aoi.has_value());
}

TEST(Experiment, OmittedFieldsAreTableTwo) {
  const Experiment experiment = Parse("");
  EXPECT_EQ(experiment.schedule().episodes(), 20000);
  EXPECT_EQ(experiment.agent().replay_capacity(), 40000);
  EXPECT_EQ(experiment.agent().batch_size(), 200);
  EXPECT_EQ(experiment.schedule().linear().initial(), 0.9);
  EXPECT_EQ(experiment.schedule().linear().decrement(), 0.0001);
  EXPECT_TRUE(experiment.schedule().linear().has_minimum());
  EXPECT_EQ(experiment.schedule().linear().minimum(), 0);
  EXPECT_EQ(experiment.agent().exponential().initial(), 0.002);
  EXPECT_EQ(experiment.agent().exponential().decay_rate(), 0.95);
  EXPECT_EQ(experiment.agent().exponential().decay_steps(), 10000);
  EXPECT_EQ(experiment.agent().target_update_period(), 300);
  EXPECT_TRUE(experiment.agent().has_adam());
  EXPECT_THAT(experiment.network_shape().layer_sizes(), ElementsAre(7, 200, 256, 20));
  EXPECT_FALSE(experiment.mask_options().safe_actions);
  EXPECT_FALSE(experiment.mask_options().coverage);
}

TEST(Experiment, ItsTextIsTheSameExperiment) {
  const std::string power = "scenario { transmit_power_w: 0.1 sensor { x_m: 0.1 y_m: 1e-7 weight: 0.3 } }";
  const std::string ladder =
      "agent { linear {} hidden_layers: 5 } schedule { ladder {} seed: 18446744073709551615 }";
  for (const std::string& text : {std::string(), power, ladder, std::string("run { actors: 7 }")}) {
    const Experiment first = Parse(text);
    const Experiment second = Parse(first.Text());
    EXPECT_EQ(second.hash(), first.hash()) << text;
    EXPECT_EQ(second.Text(), first.Text());
    EXPECT_EQ(Parse(first.CanonicalText()).hash(), first.hash()) << text;
    EXPECT_NE(first.hash(), 0u);
  }
}

TEST(Experiment, WritingADefaultOutDoesNotChangeTheHash) {
  EXPECT_EQ(
      Parse("agent { batch_size: 200 hidden_layers: [200, 256] } scenario { start { row: 0 column: 10 } }")
          .hash(),
      Parse("").hash());
}

TEST(Experiment, TheRunSectionDoesNotChangeTheHash) {
  const Experiment experiment =
      Parse("run { actors: 9 environments_per_actor: 3 lcm_url: \"memq://\" channel_prefix: \"OTHER\" }");
  EXPECT_EQ(experiment.hash(), Parse("").hash());
  EXPECT_EQ(experiment.CanonicalText(), Parse("").CanonicalText());
  EXPECT_EQ(experiment.run().channel_prefix(), "OTHER");
}

/// For every field that decides the weights, another valid value, with what must go along with it.
const std::map<std::string, Settings> kOtherValues = {
    {"scenario.grid.columns", {{"scenario.grid.columns", "21"}}},
    {"scenario.grid.rows", {{"scenario.grid.rows", "21"}}},
    {"scenario.grid.cell_m", {{"scenario.grid.cell_m", "50"}, {"scenario.speed_mps", "50"}}},
    {"scenario.slots", {{"scenario.slots", "60"}}},
    {"scenario.slot_s", {{"scenario.slot_s", "2"}, {"scenario.speed_mps", "12.5"}}},
    {"scenario.speed_mps", {{"scenario.slot_s", "2"}, {"scenario.speed_mps", "12.5"}}},
    {"scenario.start.column", {{"scenario.start.column", "9"}}},
    {"scenario.start.row", {{"scenario.start.row", "1"}}},
    {"scenario.stop.column", {{"scenario.stop.column", "9"}}},
    {"scenario.stop.row", {{"scenario.stop.row", "18"}}},
    {"scenario.sensor.x_m", {{"scenario.sensor[0].x_m", "26"}}},
    {"scenario.sensor.y_m", {{"scenario.sensor[1].y_m", "51"}}},
    {"scenario.sensor.weight", {{"scenario.sensor[1].weight", "2"}}},
    {"scenario.random_sensors.count", {{"scenario.random_sensors.count", "4"}}},
    {"scenario.random_sensors.seed", {{"scenario.random_sensors.seed", "3"}}},
    {"scenario.coverage_radius_m", {{"scenario.coverage_radius_m", "50"}}},
    {"scenario.transmit_power_w", {{"scenario.transmit_power_w", "0.1"}}},
    {"scenario.initial_energy_j", {{"scenario.initial_energy_j", "20000"}}},
    {"scenario.maximum_aoi", {{"scenario.maximum_aoi", "30"}}},
};

/// A value that differs from the default of the fields that no other field depends on.
std::string OtherValue(const FieldDescriptor& field) {
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return std::to_string(0.75 * field.default_value_double() + 0.01);
    case FieldDescriptor::CPPTYPE_BOOL:
      return "true";
    case FieldDescriptor::CPPTYPE_ENUM:
      return "EPISODES";
    case FieldDescriptor::CPPTYPE_INT32:
      return std::to_string(field.default_value_int32() + 5);
    case FieldDescriptor::CPPTYPE_INT64:
      return std::to_string(field.default_value_int64() + 5);
    default:
      return "77";
  }
}

void ExpectEveryFieldChangesTheHash(const Descriptor& descriptor, const std::string& path) {
  for (int i = 0; i < descriptor.field_count(); ++i) {
    const FieldDescriptor& field = *descriptor.field(i);
    const std::string name = path + "." + field.name();
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
      ExpectEveryFieldChangesTheHash(*field.message_type(), name);
      continue;
    }
    const bool placed = name.starts_with("scenario.sensor.");
    const std::string base =
        placed ? "scenario { sensor { x_m: 25 y_m: 50 } sensor { x_m: 75 y_m: 50 } }" : "";
    const auto listed = kOtherValues.find(name);
    const Settings settings =
        listed != kOtherValues.end() ? listed->second : Settings{{name, OtherValue(field)}};
    EXPECT_NE(Parse(base, settings).hash(), Parse(base).hash()) << name;
  }
}

TEST(Experiment, EveryOtherFieldChangesTheHash) {
  ExpectEveryFieldChangesTheHash(*proto::Scenario::descriptor(), "scenario");
  ExpectEveryFieldChangesTheHash(*proto::Agent::descriptor(), "agent");
  ExpectEveryFieldChangesTheHash(*proto::Schedule::descriptor(), "schedule");
}

}  // namespace
}  // namespace fresco
