#include "msgs/experiment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/bytes.h"
#include "tests/msgs/uav_world_of.h"
#include "tests/support/error_of.h"

namespace fresco {
namespace {

TEST(Experiment, TakesTablesIAndIIWhereNothingIsSaid) {
  const Experiment experiment = Experiment::Parse("", "nothing");
  const Scenario& scenario = UavWorldOf(experiment).scenario();
  EXPECT_EQ(scenario.columns, 20);
  EXPECT_EQ(scenario.rows, 20);
  EXPECT_EQ(scenario.cell_m, 25);
  EXPECT_EQ(scenario.slots, 70);
  EXPECT_EQ(scenario.start, (Cell{10, 0}));
  EXPECT_EQ(scenario.stop, (Cell{10, 19}));
  EXPECT_NEAR(scenario.initial_energy_j, 2.2e4, 1e-6);
  EXPECT_EQ(scenario.radio.bandwidth_hz, 1e6);
  EXPECT_EQ(scenario.radio.update_bits, 5e6);
  EXPECT_EQ(scenario.radio.noise_dbm, -100);
  EXPECT_EQ(scenario.radio.gain_at_1m_db, -60);
  EXPECT_EQ(scenario.radio.altitude_m, 120);
  EXPECT_EQ(scenario.rotor.blade_profile_power_w, 99.66);
  EXPECT_EQ(scenario.rotor.induced_power_w, 120.16);
  EXPECT_EQ(scenario.rotor.tip_speed_mps, 120);
  EXPECT_EQ(scenario.rotor.induced_velocity_mps, 0.002);
  EXPECT_EQ(scenario.rotor.drag_ratio, 0.48);
  EXPECT_EQ(scenario.rotor.air_density_kgpm3, 1.225);
  EXPECT_EQ(scenario.rotor.solidity, 0.0001);
  EXPECT_EQ(scenario.rotor.disk_area_m2, 0.5);
  EXPECT_EQ(scenario.speed_mps, 25);
  const auto& agent = experiment.agent();
  const auto& schedule = experiment.schedule();
  EXPECT_EQ(schedule.episodes(), 20000);
  EXPECT_EQ(agent.replay_capacity(), 40000);
  EXPECT_EQ(agent.batch_size(), 200);
  EXPECT_EQ(schedule.linear().initial(), 0.9);
  EXPECT_EQ(schedule.linear().decrement(), 0.0001);
  EXPECT_EQ(schedule.linear().minimum(), 0);
  EXPECT_EQ(agent.exponential().initial(), 0.002);
  EXPECT_EQ(agent.exponential().decay_rate(), 0.95);
  EXPECT_EQ(agent.exponential().decay_steps(), 10000);
  EXPECT_EQ(agent.target_update_period(), 300);
  EXPECT_EQ(experiment.network()->layer_sizes(), (std::vector<int>{7, 200, 256, 20}));
  EXPECT_EQ(Experiment::Parse("agent { sensor_geometry: true }", "a").network()->inputs(), 13);
  EXPECT_FALSE(agent.safe_action_mask() || agent.coverage_mask() || agent.double_dqn());
  EXPECT_EQ(agent.discount(), 1);
}

TEST(Experiment, ReadsItsOwnTextAsTheSame) {
  const Experiment experiment =
      Experiment::Parse("scenario { slots: 40 stop { row: 5 } } agent { linear {} }", "a");
  const Experiment again = Experiment::Parse(experiment.Text(), "b");
  EXPECT_EQ(again.Text(), experiment.Text());
  EXPECT_EQ(again.hash(), experiment.hash());
  EXPECT_EQ(UavWorldOf(again).scenario().stop, (Cell{0, 5}));
}

TEST(Experiment, HashIsThatOfWhatDecidesTheWeights) {
  const uint32_t hash = Experiment::Parse("", "a").hash();
  EXPECT_EQ(Experiment::Parse("run { actors: 7 lcm_url: \"memq://\" }", "a").hash(), hash);
  EXPECT_EQ(Experiment::Parse("scenario { slots: 70 }", "a").hash(), hash);  // the default, said aloud
  for (const std::string text : {"scenario { slots: 71 }", "agent { discount: 0.9 }", "schedule { seed: 2 }",
                                 "schedule { ladder {} }", "scenario { sensor { x_m: 1 y_m: 2 } }",
                                 "cartpole {}", "acrobot {}", "schedule { evaluation_episodes: 2 }"}) {
    EXPECT_NE(Experiment::Parse(text, "a").hash(), hash) << text;
  }
}

TEST(Experiment, StartsFromRandomParametersOrThoseOfAPolicy) {
  const Experiment experiment = Experiment::Parse("agent { hidden_layers: [3] }", "a");
  EXPECT_TRUE(experiment.FirstParameters() == experiment.network()->InitialParameters(1));
  const auto start = std::make_shared<const Vector>(experiment.network()->InitialParameters(9));
  const Experiment started = experiment.StartingFrom(start);
  EXPECT_TRUE(started.FirstParameters() == *start);
  EXPECT_EQ(started.agent().start_crc32c(), Crc32c(Values(*start)));
  EXPECT_NE(started.hash(), experiment.hash());
  EXPECT_EQ(experiment.start(), nullptr);
  // The text has only the CRC: whoever reads it has to bring the parameters.
  const Experiment read = Experiment::Parse(started.Text(), "b");
  EXPECT_EQ(read.hash(), started.hash());
  EXPECT_THAT(ErrorOf([&] { read.FirstParameters(); }),
              testing::AllOf(testing::HasSubstr("agent.start_crc32c"), testing::HasSubstr("--start-from")));
  EXPECT_EQ(read.StartingFrom(start).hash(), started.hash());
}

}  // namespace
}  // namespace fresco
