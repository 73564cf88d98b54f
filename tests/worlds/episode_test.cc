// The record of an episode. Episodes as they were recorded are accepted; change one thing and they are not.
#include "worlds/episode.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "tests/worlds/table_one.h"
#include "tests/worlds/test_scenarios.h"
#include "tests/worlds/walk_world.h"
#include "worlds/uav/flight.h"

namespace fresco {
namespace {

using testing::ElementsAre;

class EpisodeCheck : public ::testing::Test {
 protected:
  explicit EpisodeCheck(MaskOptions mask = {true, true})
      : world_(SquareField(5, 14, {0, 0}, {4, 4}, {{0, 100, 1}, {75, 25, 2}}, 30), {.mask = mask}),
        episode_(FlyRandomly(1)) {}

  Episode FlyRandomly(uint32_t index) const {
    RandomStream stream = TestStream(7, index);
    EpisodeRecorder recorder(world_, kSeed);
    while (!recorder.ended()) {
      recorder.Step(RandomAllowed(recorder.mask(), &stream));
    }
    return recorder.Release();
  }

  bool Accepts(const Episode& episode) const {
    Episode flown;
    return FlyActions(world_, kSeed, episode.actions, flown) && SameBits(episode, flown);
  }

  /// `change` is applied to a copy of the flown episode.
  void ExpectRefused(const std::function<void(Episode&)>& change, const std::string& what, size_t where) {
    Episode changed = episode_;
    change(changed);
    EXPECT_FALSE(Accepts(changed)) << what << " " << where;
  }

  static constexpr uint64_t kSeed = 3;
  UavWorld world_;
  Episode episode_;
};

class EpisodeCheckWithoutMasks : public EpisodeCheck {
 protected:
  EpisodeCheckWithoutMasks() : EpisodeCheck(MaskOptions{}) {}
};

TEST_F(EpisodeCheck, RecordsWhatTheEnvironmentSaysInEveryState) {
  for (uint32_t index = 0; index < 40; ++index) {
    const Episode episode = FlyRandomly(index);
    const std::unique_ptr<Environment> environment = world_.NewEnvironment();
    environment->Reset(kSeed);
    std::vector<float> state(static_cast<size_t>(world_.state_size()));
    std::vector<uint8_t> mask(static_cast<size_t>(world_.actions()));
    std::vector<uint8_t> masks;
    StepResult result;
    ASSERT_EQ(episode.states.size(), (episode.actions.size() + 1) * state.size());
    ASSERT_EQ(episode.rewards.size(), episode.actions.size());
    for (size_t i = 0; i < episode.actions.size(); ++i) {
      environment->WriteState(state);
      EXPECT_TRUE(std::ranges::equal(episode.state(i), state));
      result = environment->Step(episode.actions[i]);
      EXPECT_EQ(episode.rewards[i], static_cast<float>(result.reward));
      environment->WriteMask(mask);
      AppendMask(mask, masks);
    }
    environment->WriteState(state);
    EXPECT_TRUE(std::ranges::equal(episode.state(episode.actions.size()), state));
    EXPECT_EQ(episode.next_masks, masks);
    EXPECT_EQ(episode.ending, result.ending);
  }
}

TEST_F(EpisodeCheck, RecorderShowsThePresentStateAndMask) {
  EpisodeRecorder recorder(world_, kSeed);
  std::vector<float> state(static_cast<size_t>(world_.state_size()));
  std::vector<uint8_t> mask(static_cast<size_t>(world_.actions()));
  for (const int16_t action : episode_.actions) {
    EXPECT_FALSE(recorder.ended());
    recorder.environment().WriteState(state);
    EXPECT_TRUE(std::ranges::equal(recorder.state(), state));
    recorder.environment().WriteMask(mask);
    EXPECT_EQ(recorder.mask(), mask);
    recorder.Step(action);
  }
  EXPECT_TRUE(recorder.ended());
  EXPECT_EQ(recorder.episode().states, episode_.states);
}

TEST_F(EpisodeCheck, KnowsTheMemoryOfTheLongestEpisode) {
  ASSERT_EQ(episode_.transitions(), world_.longest_episode());
  const size_t bytes = sizeof(Episode) + episode_.states.size() * sizeof(float) +
                       episode_.actions.size() * sizeof(int16_t) + episode_.rewards.size() * sizeof(float) +
                       episode_.next_masks.size();
  EXPECT_EQ(LongestEpisodeBytes(world_), static_cast<int64_t>(bytes));
}

TEST_F(EpisodeCheck, AcceptsFlownEpisodes) {
  for (uint32_t index = 0; index < 40; ++index) {
    const Episode episode = FlyRandomly(index);
    EXPECT_EQ(OutcomeOf(episode), Outcome::kArrived);
    EXPECT_TRUE(Accepts(episode)) << index;
  }
}

TEST_F(EpisodeCheck, RefusesAnEpisodeWithoutSomeOfItsValues) {
  ExpectRefused([](Episode& episode) { episode.states.pop_back(); }, "state", 0);
  ExpectRefused([](Episode& episode) { episode.states.clear(); }, "states", 0);
  ExpectRefused([](Episode& episode) { episode.rewards.pop_back(); }, "reward", 0);
  ExpectRefused([](Episode& episode) { episode.next_masks.pop_back(); }, "mask", 0);
  EXPECT_FALSE(SameBits(Episode{}, episode_));
  EXPECT_TRUE(SameBits(Episode{}, Episode{}));
}

TEST_F(EpisodeCheckWithoutMasks, AcceptsFlownEpisodesThatEndEarly) {
  int early = 0;
  for (uint32_t index = 0; index < 40; ++index) {
    const Episode episode = FlyRandomly(index);
    early += OutcomeOf(episode) == Outcome::kOutOfTime ? 1 : 0;
    EXPECT_TRUE(Accepts(episode)) << index;
  }
  EXPECT_GT(early, 20);
}

TEST_F(EpisodeCheck, RefusesAnyOtherAction) {
  for (size_t i = 0; i < episode_.actions.size(); ++i) {
    for (int action = 0; action < world_.actions(); ++action) {
      if (action != episode_.actions[i]) {
        ExpectRefused([&](Episode& episode) { episode.actions[i] = static_cast<int16_t>(action); }, "action",
                      i);
      }
    }
  }
}

TEST_F(EpisodeCheck, RefusesAnyOtherBitOfARewardOrAState) {
  const auto flip = [](float& value, uint32_t bit) {
    value = std::bit_cast<float>(std::bit_cast<uint32_t>(value) ^ (1u << bit));
  };
  for (uint32_t bit = 0; bit < 32; ++bit) {
    for (size_t i = 0; i < episode_.rewards.size(); ++i) {
      ExpectRefused([&](Episode& episode) { flip(episode.rewards[i], bit); }, "reward", i);
    }
    for (size_t i = 0; i < episode_.states.size(); ++i) {
      ExpectRefused([&](Episode& episode) { flip(episode.states[i], bit); }, "state", i);
    }
  }
}

TEST_F(EpisodeCheck, RefusesValuesThatAreNotNumbers) {
  for (const float value :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    ExpectRefused([&](Episode& episode) { episode.rewards[2] = value; }, "reward", 2);
    const size_t energy = 2 * static_cast<size_t>(world_.state_size()) + kEnergyMarginField;
    ExpectRefused([&](Episode& episode) { episode.states[energy] = value; }, "energy", 2);
  }
}

TEST_F(EpisodeCheck, RefusesAnyOtherFieldOfAState) {
  for (size_t i = 0; i < episode_.states.size(); ++i) {
    for (const float change : {-1.0f, 1.0f}) {
      ExpectRefused([&](Episode& episode) { episode.states[i] += change; }, "state", i);
    }
  }
}

TEST_F(EpisodeCheck, RefusesAnyOtherBitOfAMask) {
  const auto mask_size = static_cast<size_t>(MaskSize(world_.actions()));
  for (size_t i = 0; i < episode_.actions.size(); ++i) {
    for (size_t action = 0; action < static_cast<size_t>(world_.actions()); ++action) {
      ExpectRefused(
          [&](Episode& episode) {
            uint8_t& byte = episode.next_masks[i * mask_size + action / 8];
            byte = static_cast<uint8_t>(byte ^ (1u << (action % 8)));
          },
          "mask", i);
    }
  }
}

TEST_F(EpisodeCheck, RefusesAnyOtherEnding) {
  ASSERT_EQ(episode_.ending, Ending::kTerminal);
  for (const Ending ending : {Ending::kNone, Ending::kTruncated}) {
    ExpectRefused([&](Episode& episode) { episode.ending = ending; }, "ending", static_cast<size_t>(ending));
  }
}

TEST_F(EpisodeCheck, RefusesAnEpisodeWithoutItsEndOrItsBeginning) {
  const int all_but_one = episode_.transitions() - 1;
  Episode without_end = PartOf(world_, episode_, 0, all_but_one);
  EXPECT_FALSE(Accepts(without_end));
  without_end.ending = Ending::kTerminal;
  EXPECT_FALSE(Accepts(without_end));
  Episode without_beginning = PartOf(world_, episode_, 1, all_but_one);
  EXPECT_EQ(without_beginning.ending, Ending::kTerminal);
  EXPECT_FALSE(Accepts(without_beginning));
  EXPECT_FALSE(Accepts(Episode{}));
}

TEST_F(EpisodeCheck, RefusesATransitionAfterTheEnd) {
  ExpectRefused(
      [&](Episode& episode) {
        const std::vector<float> all = episode.states;
        episode.states.insert(episode.states.end(), all.end() - world_.state_size(), all.end());
        episode.actions.push_back(static_cast<int16_t>(world_.ActionIndex({Move::kHover, 0})));
        episode.rewards.push_back(episode.rewards.back());
        episode.next_masks.resize(episode.next_masks.size() + static_cast<size_t>(MaskSize(world_.actions())),
                                  0xff);
      },
      "after the end", 0);
}

TEST(EpisodeOfAWalk, DependsOnItsSeed) {
  const WalkWorld world;
  const std::vector<int16_t> actions = {1, 0, 8, 2, 0};
  Episode first;
  Episode other;
  ASSERT_TRUE(FlyActions(world, 4, actions, first));
  ASSERT_TRUE(FlyActions(world, 5, actions, other));
  EXPECT_THAT(first.states, ElementsAre(4, 0, 5, 1, 5, 2, 13, 3, 15, 4, 15, 5));
  EXPECT_THAT(first.rewards, ElementsAre(5, 5, 13, 15, 15));
  EXPECT_FALSE(SameBits(other, first));
  EXPECT_EQ(first.seed, 4u);
}

TEST(EpisodeOfAWalk, RecordsHowItEnded) {
  const WalkWorld world;
  Episode episode;
  ASSERT_TRUE(FlyActions(world, 4, std::vector<int16_t>(5, 0), episode));
  EXPECT_EQ(episode.ending, Ending::kTruncated);
  EXPECT_EQ(episode.transitions(), 5);
  ASSERT_TRUE(FlyActions(world, 4, std::vector<int16_t>(5, 8), episode));  // and the rest is ignored
  EXPECT_EQ(episode.ending, Ending::kTerminal);
  EXPECT_EQ(episode.transitions(), 3);
}

TEST(EpisodeOfAWalk, FillsMasksUpToAByteWithZeros) {
  const WalkWorld world;
  Episode episode;
  ASSERT_TRUE(FlyActions(world, 4, std::vector<int16_t>(5, 8), episode));
  EXPECT_EQ(MaskSize(world.actions()), 2);
  EXPECT_THAT(episode.next_masks, ElementsAre(0xff, 1, 0xff, 1, 0xff, 1));  // nine actions
}

TEST(EpisodeOfAWalk, RefusesActionsThatAreNoneOrTooFew) {
  const WalkWorld world;
  Episode episode;
  EXPECT_FALSE(FlyActions(world, 4, std::vector<int16_t>{0, -1, 0, 0, 0}, episode));
  EXPECT_FALSE(FlyActions(world, 4, std::vector<int16_t>{0, 9, 0, 0, 0}, episode));
  EXPECT_FALSE(FlyActions(world, 4, std::vector<int16_t>(4, 0), episode));
}

TEST(EpisodeOfAWalk, HasNothingLeftOnceItIsCleared) {
  const WalkWorld world;
  Episode episode;
  ASSERT_TRUE(FlyActions(world, 4, std::vector<int16_t>(5, 0), episode));
  episode.Clear();
  EXPECT_EQ(episode.ending, Ending::kNone);
  EXPECT_EQ(episode.transitions(), 0);
  EXPECT_TRUE(episode.states.empty() && episode.rewards.empty() && episode.next_masks.empty());
}

}  // namespace
}  // namespace fresco
