// Episodes over the wire: in pieces that fit a frame, and back the same to the bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "core/random.h"
#include "msgs/episode.h"
#include "tests/msgs/message_samples.h"

namespace fresco {
namespace {

Scenario ScenarioWith(int sensors) {
  Scenario scenario;
  scenario.sensors = RandomSensors(scenario.columns, scenario.rows, scenario.cell_m, sensors, 4);
  return scenario;
}

/// An episode of random allowed actions.
Episode RandomEpisode(const World& world, RandomStream& stream) {
  Environment environment(world);
  environment.Reset();
  Episode episode;
  episode.order_index = 12;
  episode.states.push_back(environment.state());
  std::vector<uint8_t> mask(static_cast<size_t>(world.actions()));
  while (environment.outcome() == Outcome::kFlying) {
    environment.WriteMask({true, false}, mask);
    int action = 0;
    do {
      action = static_cast<int>(stream.NextBelow(static_cast<uint32_t>(world.actions())));
    } while (mask[static_cast<size_t>(action)] == 0);
    const StepResult result = environment.Step(world.ActionAt(action));
    episode.actions.push_back(static_cast<int16_t>(action));
    episode.rewards.push_back(static_cast<float>(result.reward));
    episode.td_errors.push_back(static_cast<float>(stream.NextUniform()));
    episode.states.push_back(environment.state());
    for (int i = 0; i < MaskSize(world); ++i) {
      episode.next_masks.push_back(static_cast<uint8_t>(stream.NextWord()));
    }
  }
  episode.outcome = environment.outcome();
  return episode;
}

std::vector<transitions_t> Messages(const World& world, const Episode& episode) {
  std::vector<transitions_t> messages;
  SplitEpisode(world, episode, 5, [&](const transitions_t& message) {
    const std::vector<std::byte> bytes = Encoded(message);
    EXPECT_LE(bytes.size(), kMaximumMessageBytes);
    EXPECT_TRUE(Decode(bytes, messages.emplace_back()));
  });
  return messages;
}

class EpisodeCodec : public ::testing::TestWithParam<int> {};

TEST_P(EpisodeCodec, JoinsToTheSameEpisode) {
  const World world(ScenarioWith(GetParam()));
  RandomStream stream(static_cast<uint64_t>(GetParam()), RandomPurpose::kTest, 0, 0);
  const Episode episode = RandomEpisode(world, stream);
  int next = 0;
  for (const transitions_t& message : Messages(world, episode)) {
    EXPECT_EQ(message.actor_id, 5);
    Episode run;
    ASSERT_TRUE(ToEpisodeRun(world, message, run));
    EXPECT_EQ(run.order_index, 12);
    ASSERT_EQ(run.first_transition, next);
    for (int i = 0; i <= run.transitions(); ++i) {
      const State& state = run.states[static_cast<size_t>(i)];
      const State& expected = episode.states[static_cast<size_t>(next + i)];
      EXPECT_EQ(state.slot, expected.slot);
      EXPECT_EQ(state.cell, expected.cell);
      EXPECT_EQ(state.time_margin, expected.time_margin);
      EXPECT_EQ(state.energy_margin_j, expected.energy_margin_j);
      EXPECT_EQ(state.aoi, expected.aoi);
    }
    for (int i = 0; i < run.transitions(); ++i) {
      const auto from = static_cast<size_t>(next + i);
      EXPECT_EQ(run.actions[static_cast<size_t>(i)], episode.actions[from]);
      EXPECT_EQ(run.rewards[static_cast<size_t>(i)], episode.rewards[from]);
      EXPECT_EQ(run.td_errors[static_cast<size_t>(i)], episode.td_errors[from]);
    }
    const auto begin = episode.next_masks.begin() + next * MaskSize(world);
    EXPECT_TRUE(std::equal(run.next_masks.begin(), run.next_masks.end(), begin));
    next += run.transitions();
    EXPECT_EQ(run.outcome, next == episode.transitions() ? episode.outcome : Outcome::kFlying);
  }
  EXPECT_EQ(next, episode.transitions());
}

INSTANTIATE_TEST_SUITE_P(Sensors, EpisodeCodec, ::testing::Values(1, 3, 8, 60, 249, 250));

TEST(EpisodeRun, RefusesValuesThatTheWorldCannotHave) {
  const World world(ScenarioWith(3));
  RandomStream stream(1, RandomPurpose::kTest, 0, 0);
  const transitions_t good = Messages(world, RandomEpisode(world, stream)).front();
  const std::vector<std::function<void(transitions_t&)>> lies = {
      [](auto& m) { m.action[0] = 20; },
      [](auto& m) { m.action[1] = -1; },
      [](auto& m) { m.column[0] = 20; },
      [](auto& m) { m.row[2] = -1; },
      [](auto& m) { m.aoi[1][0] = 0; },
      [](auto& m) { m.aoi[1][2] = 71; },
      [](auto& m) { m.reward[0] = std::numeric_limits<float>::quiet_NaN(); },
      [](auto& m) { m.td_error[0] = std::nanf(""); },
      [](auto& m) { m.td_error[0] = -std::numeric_limits<float>::infinity(); },
      [](auto& m) { m.energy_margin_j[0] = std::numeric_limits<float>::infinity(); },
      [](auto& m) { m.first_transition = -1; },
      [](auto& m) { m.first_transition = 60; },
      [](auto& m) { m.outcome = 4; },
      [](auto& m) { m.order_index = -1; },
      [](auto& m) { m.sensor_count = 2; },
      [](auto& m) { m.mask_size = 2; },
      [](auto& m) { m.state_count = m.transition_count; },
  };
  Episode run;
  ASSERT_TRUE(ToEpisodeRun(world, good, run));
  for (size_t i = 0; i < lies.size(); ++i) {
    transitions_t message = good;
    lies[i](message);
    EXPECT_FALSE(ToEpisodeRun(world, message, run)) << i;
  }
}

}  // namespace
}  // namespace fresco
