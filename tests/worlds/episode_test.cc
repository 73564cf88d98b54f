// The record of an episode. Episodes as they were flown are accepted; change one thing and they are not.
#include "worlds/uav/episode.h"

#include <gtest/gtest.h>

#include <bit>
#include <functional>
#include <limits>

#include "tests/worlds/table_one.h"
#include "tests/worlds/test_scenarios.h"

namespace fresco {
namespace {

class EpisodeCheck : public ::testing::Test {
 protected:
  explicit EpisodeCheck(MaskOptions mask_options = {true, true})
      : mask_options_(mask_options), episode_(FlyRandomly(1)) {}

  Episode FlyRandomly(uint32_t index) const {
    RandomStream stream = TestStream(7, index);
    EpisodeRecorder recorder(world_, mask_options_);
    while (recorder.episode().outcome == Outcome::kFlying) {
      recorder.Step(world_.ActionIndex(RandomAction(world_, recorder.environment(), mask_options_, &stream)));
    }
    return recorder.Release();
  }

  bool Accepts(const Episode& episode) const {
    Episode flown;
    return FlyActions(world_, mask_options_, episode.actions, flown) &&
           flown.transitions() == episode.transitions() && IsPartOf(episode, 0, flown);
  }

  /// `change` is applied to a copy of the flown episode.
  void ExpectRefused(const std::function<void(Episode&)>& change, const std::string& what, size_t where) {
    Episode changed = episode_;
    change(changed);
    EXPECT_FALSE(Accepts(changed)) << what << " " << where;
  }

  World world_{SquareField(5, 14, {0, 0}, {4, 4}, {{0, 100, 1}, {75, 25, 2}}, 30)};
  MaskOptions mask_options_;
  Episode episode_;
};

class EpisodeCheckWithoutMasks : public EpisodeCheck {
 protected:
  EpisodeCheckWithoutMasks() : EpisodeCheck(MaskOptions{}) {}
};

TEST_F(EpisodeCheck, RecordsWhatTheEnvironmentSaysInEverySlot) {
  for (uint32_t index = 0; index < 40; ++index) {
    const Episode episode = FlyRandomly(index);
    Environment environment(world_);
    std::vector<uint8_t> mask(static_cast<size_t>(world_.actions()));
    std::vector<uint8_t> masks;
    ASSERT_EQ(episode.states.size(), episode.actions.size() + 1);
    for (size_t i = 0; i < episode.actions.size(); ++i) {
      EXPECT_EQ(episode.states[i].cell, environment.state().cell);
      EXPECT_EQ(episode.states[i].aoi, environment.state().aoi);
      EXPECT_EQ(EnergyIn(world_, episode, i), environment.remaining_energy_j());
      EXPECT_EQ(ActionIn(world_, episode, i), world_.ActionAt(episode.actions[i]));
      const StepResult result = environment.Step(world_.ActionAt(episode.actions[i]));
      EXPECT_EQ(episode.rewards[i], static_cast<float>(result.reward));
      environment.WriteMask(mask_options_, mask);
      AppendMask(mask, masks);
    }
    EXPECT_EQ(episode.next_masks, masks);
    EXPECT_EQ(episode.outcome, environment.outcome());
    EXPECT_EQ(ResidualEnergy(world_, episode), environment.remaining_energy_j());
    EXPECT_EQ(ActionIn(world_, episode, episode.actions.size()), Action{});
  }
}

TEST_F(EpisodeCheck, AcceptsFlownEpisodes) {
  for (uint32_t index = 0; index < 40; ++index) {
    const Episode episode = FlyRandomly(index);
    EXPECT_EQ(episode.outcome, Outcome::kArrived);
    EXPECT_TRUE(Accepts(episode)) << index;
  }
}

TEST_F(EpisodeCheck, AcceptsEveryPartOfAnEpisodeAtItsPlaceAlone) {
  const int transitions = episode_.transitions();
  for (int first = 0; first < transitions; ++first) {
    for (int count = 1; first + count <= transitions; ++count) {
      const Episode part = PartOf(world_, episode_, first, count);
      const int elsewhere = first + (first + count < transitions ? 1 : -1);
      EXPECT_TRUE(IsPartOf(part, first, episode_)) << first << " " << count;
      EXPECT_FALSE(IsPartOf(part, elsewhere, episode_)) << first << " " << count;
    }
  }
  EXPECT_FALSE(IsPartOf(Episode{}, 0, episode_));
}

TEST_F(EpisodeCheckWithoutMasks, AcceptsFlownEpisodesThatEndEarly) {
  int early = 0;
  for (uint32_t index = 0; index < 40; ++index) {
    const Episode episode = FlyRandomly(index);
    early += episode.outcome == Outcome::kOutOfTime ? 1 : 0;
    EXPECT_TRUE(Accepts(episode)) << index;
  }
  EXPECT_GT(early, 20);
}

TEST_F(EpisodeCheck, RefusesAnyOtherAction) {
  for (size_t i = 0; i < episode_.actions.size(); ++i) {
    for (int16_t action = 0; action < world_.actions(); ++action) {
      if (action != episode_.actions[i]) {
        ExpectRefused([&](Episode& episode) { episode.actions[i] = action; }, "action", i);
      }
    }
  }
}

TEST_F(EpisodeCheck, RefusesAnyOtherBitOfARewardOrAnEnergyMargin) {
  const auto flip = [](float& value, uint32_t bit) {
    value = std::bit_cast<float>(std::bit_cast<uint32_t>(value) ^ (1u << bit));
  };
  for (uint32_t bit = 0; bit < 32; ++bit) {
    for (size_t i = 0; i < episode_.rewards.size(); ++i) {
      ExpectRefused([&](Episode& episode) { flip(episode.rewards[i], bit); }, "reward", i);
    }
    for (size_t i = 0; i < episode_.states.size(); ++i) {
      ExpectRefused([&](Episode& episode) { flip(episode.states[i].energy_margin_j, bit); }, "energy", i);
    }
  }
}

TEST_F(EpisodeCheck, RefusesValuesThatAreNotNumbers) {
  for (const float value :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    ExpectRefused([&](Episode& episode) { episode.rewards[2] = value; }, "reward", 2);
    ExpectRefused([&](Episode& episode) { episode.states[2].energy_margin_j = value; }, "energy", 2);
  }
}

TEST_F(EpisodeCheck, RefusesAnyOtherFieldOfAState) {
  for (size_t i = 0; i < episode_.states.size(); ++i) {
    for (const int change : {-1, 1}) {
      ExpectRefused([&](Episode& episode) { episode.states[i].slot += change; }, "slot", i);
      ExpectRefused([&](Episode& episode) { episode.states[i].cell.column += change; }, "column", i);
      ExpectRefused([&](Episode& episode) { episode.states[i].cell.row += change; }, "row", i);
      ExpectRefused([&](Episode& episode) { episode.states[i].time_margin += change; }, "time", i);
      for (size_t sensor = 0; sensor < 2; ++sensor) {
        ExpectRefused(
            [&](Episode& episode) {
              int16_t& aoi = episode.states[i].aoi[sensor];
              aoi = static_cast<int16_t>(aoi + change);
            },
            "aoi", i);
      }
    }
  }
}

TEST_F(EpisodeCheck, RefusesAnyOtherBitOfAMask) {
  const auto mask_size = static_cast<size_t>(MaskSize(world_));
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

TEST_F(EpisodeCheck, RefusesAnyOtherOutcome) {
  for (const Outcome outcome : {Outcome::kFlying, Outcome::kOutOfTime, Outcome::kOutOfEnergy}) {
    ExpectRefused([&](Episode& episode) { episode.outcome = outcome; }, "outcome",
                  static_cast<size_t>(outcome));
  }
}

TEST_F(EpisodeCheck, RefusesAnEpisodeWithoutItsEndOrItsBeginning) {
  const int all_but_one = episode_.transitions() - 1;
  Episode without_end = PartOf(world_, episode_, 0, all_but_one);
  EXPECT_FALSE(Accepts(without_end));
  without_end.outcome = Outcome::kArrived;
  EXPECT_FALSE(Accepts(without_end));
  Episode without_beginning = PartOf(world_, episode_, 1, all_but_one);
  EXPECT_EQ(without_beginning.outcome, Outcome::kArrived);
  EXPECT_FALSE(Accepts(without_beginning));
  EXPECT_FALSE(Accepts(Episode{}));
}

TEST_F(EpisodeCheck, RefusesATransitionAfterTheEnd) {
  ExpectRefused(
      [&](Episode& episode) {
        episode.states.push_back(episode.states.back());
        episode.actions.push_back(static_cast<int16_t>(world_.ActionIndex({Move::kHover, 0})));
        episode.rewards.push_back(episode.rewards.back());
        episode.next_masks.resize(episode.next_masks.size() + static_cast<size_t>(MaskSize(world_)), 0xff);
      },
      "after the end", 0);
}

}  // namespace
}  // namespace fresco
