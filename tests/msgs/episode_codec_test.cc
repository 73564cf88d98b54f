#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "core/random.h"
#include "msgs/episode.h"

namespace fresco {
namespace {

constexpr uint32_t kThisTest = 3;
constexpr RunIdentity kIdentity{0x1234, 0xabcd};
constexpr int64_t kActorId = -99;

World WorldOf(int sensors) {
  Scenario scenario;
  scenario.sensors = RandomSensors(scenario.columns, scenario.rows, scenario.cell_m, sensors, 4);
  return World(scenario);
}

void AppendMask(const std::vector<uint8_t>& mask, Episode& episode) {
  std::vector<uint8_t> packed((mask.size() + 7) / 8);
  for (size_t action = 0; action < mask.size(); ++action) {
    packed[action / 8] = static_cast<uint8_t>(packed[action / 8] | mask[action] << action % 8);
  }
  episode.next_masks.insert(episode.next_masks.end(), packed.begin(), packed.end());
}

/// An episode of random actions that the mask allows, with made-up temporal-difference errors.
Episode RandomEpisode(const World& world, MaskOptions options, uint32_t index) {
  RandomStream stream(2026, RandomPurpose::kTest, kThisTest, index);
  Environment environment(world);
  environment.Reset();
  Episode episode;
  episode.order_index = index;
  episode.states.push_back(environment.state());
  std::vector<uint8_t> mask(static_cast<size_t>(world.actions()));
  environment.WriteMask(options, mask);
  while (environment.outcome() == Outcome::kFlying) {
    uint32_t action = stream.NextBelow(static_cast<uint32_t>(world.actions()));
    while (mask[action] == 0) {
      action = stream.NextBelow(static_cast<uint32_t>(world.actions()));
    }
    const StepResult result = environment.Step(world.ActionAt(static_cast<int>(action)));
    environment.WriteMask(options, mask);
    episode.actions.push_back(static_cast<int16_t>(action));
    episode.rewards.push_back(static_cast<float>(result.reward));
    episode.td_errors.push_back(static_cast<float>(stream.NextUniform() - 0.5));
    episode.states.push_back(environment.state());
    AppendMask(mask, episode);
  }
  episode.outcome = environment.outcome();
  return episode;
}

std::vector<transitions_t> Sent(const World& world, const Episode& episode) {
  std::vector<transitions_t> messages;
  SendEpisode(world, episode, kIdentity, kActorId, [&](std::span<const std::byte> bytes) {
    ASSERT_LE(bytes.size(), kMaximumEncodedBytes);
    ASSERT_TRUE(Decode(bytes, messages.emplace_back()));
  });
  return messages;
}

/// Appends a run that continues the episode.
void Join(const Episode& run, Episode& episode) {
  ASSERT_EQ(run.first_transition, episode.transitions());
  ASSERT_EQ(episode.outcome, Outcome::kFlying) << "only the last run ends the episode";
  const auto append = [](const auto& from, auto& to, ptrdiff_t skipped = 0) {
    to.insert(to.end(), from.begin() + skipped, from.end());
  };
  episode.order_index = run.order_index;
  episode.outcome = run.outcome;
  append(run.states, episode.states, episode.states.empty() ? 0 : 1);
  append(run.actions, episode.actions);
  append(run.rewards, episode.rewards);
  append(run.td_errors, episode.td_errors);
  append(run.next_masks, episode.next_masks);
}

void ExpectEqual(const Episode& left, const Episode& right) {
  EXPECT_EQ(left.order_index, right.order_index);
  EXPECT_EQ(left.outcome, right.outcome);
  EXPECT_EQ(left.actions, right.actions);
  EXPECT_EQ(left.rewards, right.rewards);
  EXPECT_EQ(left.td_errors, right.td_errors);
  EXPECT_EQ(left.next_masks, right.next_masks);
  ASSERT_EQ(left.states.size(), right.states.size());
  for (size_t i = 0; i < left.states.size(); ++i) {
    EXPECT_EQ(left.states[i].slot, right.states[i].slot) << i;
    EXPECT_EQ(left.states[i].cell, right.states[i].cell) << i;
    EXPECT_EQ(left.states[i].time_margin, right.states[i].time_margin) << i;
    EXPECT_EQ(left.states[i].energy_margin_j, right.states[i].energy_margin_j) << i;
    EXPECT_EQ(left.states[i].aoi, right.states[i].aoi) << i;
  }
}

class EpisodeCodec : public testing::TestWithParam<int> {};

TEST_P(EpisodeCodec, GivesBackTheEpisodeExactly) {
  const World world = WorldOf(GetParam());
  for (const MaskOptions options : {MaskOptions{}, {true, false}, {false, true}, {true, true}}) {
    for (uint32_t index = 0; index < 5; ++index) {
      const Episode episode = RandomEpisode(world, options, index);
      Episode joined;
      Episode run;
      for (const transitions_t& message : Sent(world, episode)) {
        EXPECT_EQ(IdentityOf(message), kIdentity);
        EXPECT_EQ(message.actor_id, kActorId);
        ASSERT_TRUE(ToEpisodeRun(world, message, run));
        Join(run, joined);
      }
      ExpectEqual(joined, episode);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sensors, EpisodeCodec, testing::Values(1, 3, 8, 60, 250));

TEST(EpisodeRun, IsRefusedWithValuesThatTheWorldDoesNotHave) {
  const World world = WorldOf(3);
  const transitions_t valid = Sent(world, RandomEpisode(world, {true, true}, 7)).front();
  Episode run;
  ASSERT_TRUE(ToEpisodeRun(world, valid, run));
  EXPECT_FALSE(ToEpisodeRun(WorldOf(4), valid, run));
  const auto refused = [&](auto change) {
    transitions_t message = valid;
    change(message);
    return !ToEpisodeRun(world, message, run);
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(refused([](transitions_t& m) { m.action[1] = 20; }));
  EXPECT_TRUE(refused([](transitions_t& m) { m.action.back() = -1; }));
  EXPECT_TRUE(refused([](transitions_t& m) { m.column[1] = 20; }));
  EXPECT_TRUE(refused([](transitions_t& m) { m.column[1] = -1; }));
  EXPECT_TRUE(refused([](transitions_t& m) { m.row.back() = 20; }));
  EXPECT_TRUE(refused([](transitions_t& m) { m.row[0] = -1; }));
  EXPECT_TRUE(refused([](transitions_t& m) { m.aoi[1][2] = 0; }));
  EXPECT_TRUE(refused([](transitions_t& m) { m.aoi.back()[0] = 71; }));
  EXPECT_TRUE(refused([&](transitions_t& m) { m.reward[0] = nan; }));
  EXPECT_TRUE(refused([&](transitions_t& m) { m.td_error[0] = nan; }));
  EXPECT_TRUE(refused([&](transitions_t& m) { m.energy_margin_j[0] = nan; }));
  EXPECT_TRUE(refused([](transitions_t& m) { m.order_index = -1; }));
  EXPECT_TRUE(refused([](transitions_t& m) { m.outcome = 4; }));
  EXPECT_TRUE(refused([](transitions_t& m) { m.outcome = -1; }));
}

TEST(EpisodeRun, IsRefusedWhereItsPlaceOrSizesAreImpossible) {
  const World world = WorldOf(3);
  const transitions_t valid = Sent(world, RandomEpisode(world, {true, true}, 8)).front();
  Episode run;
  const auto refused = [&](auto change) {
    transitions_t message = valid;
    change(message);
    return !ToEpisodeRun(world, message, run);
  };
  const int32_t last = world.maximum_transitions() - valid.transition_count;
  EXPECT_FALSE(refused([&](transitions_t& m) { m.first_transition = last; }));
  for (const int32_t first :
       {-1, last + 1, std::numeric_limits<int32_t>::min(), std::numeric_limits<int32_t>::max(),
        std::numeric_limits<int32_t>::max() - valid.transition_count + 1}) {
    EXPECT_TRUE(refused([&](transitions_t& m) { m.first_transition = first; })) << first;
  }
  EXPECT_TRUE(refused([](transitions_t& m) { m.transition_count = 0, m.state_count = 1; }));
  EXPECT_TRUE(refused([](transitions_t& m) { ++m.state_count; }));
  EXPECT_TRUE(refused([](transitions_t& m) { --m.sensor_count; }));
  EXPECT_TRUE(refused([](transitions_t& m) { --m.mask_size; }));
}

}  // namespace
}  // namespace fresco
