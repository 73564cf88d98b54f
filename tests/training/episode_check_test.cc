// Flown episodes are accepted; change one thing and they are not.
#include "training/episode_check.h"

#include <gtest/gtest.h>

#include <bit>
#include <functional>
#include <limits>

#include "tests/training/literal_run.h"

namespace fresco {
namespace {

const Settings kWithoutMasks = {{"agent.safe_action_mask", "false"}, {"agent.coverage_mask", "false"}};

class EpisodeCheck : public ::testing::Test {
 protected:
  explicit EpisodeCheck(const Settings& settings = {})
      : experiment_(SmallExperiment(settings)), world_(experiment_.scenario()), episode_(Fly(1, 0.8)) {}

  Episode Fly(uint64_t seed, double epsilon) const {
    Order order;
    order.seed = seed;
    order.epsilon = epsilon;
    const auto parameters =
        std::make_shared<const Vector>(InitialParameters(experiment_.network_shape(), seed));
    return FlyOrder(world_, experiment_, order, parameters, parameters);
  }

  bool Accepts(const Episode& episode) const {
    Episode flown;
    return FlyActions(world_, experiment_.mask_options(), episode.actions, flown) &&
           flown.transitions() == episode.transitions() && IsPartOf(episode, flown);
  }

  /// `change` is applied to a copy of the flown episode.
  void ExpectRefused(const std::function<void(Episode&)>& change, const std::string& what, size_t where) {
    Episode changed = episode_;
    change(changed);
    EXPECT_FALSE(Accepts(changed)) << what << " " << where;
  }

  Experiment experiment_;
  World world_;
  Episode episode_;
};

class EpisodeCheckWithoutMasks : public EpisodeCheck {
 protected:
  EpisodeCheckWithoutMasks() : EpisodeCheck(kWithoutMasks) {}
};

TEST_F(EpisodeCheck, AcceptsFlownEpisodes) {
  for (uint64_t seed = 0; seed < 40; ++seed) {
    const Episode episode = Fly(seed, static_cast<double>(seed % 3) / 2);
    EXPECT_EQ(episode.outcome, Outcome::kArrived);
    EXPECT_TRUE(Accepts(episode)) << seed;
  }
}

TEST_F(EpisodeCheck, AcceptsEveryPartOfAnEpisodeAtItsPlaceAlone) {
  const int transitions = episode_.transitions();
  for (int first = 0; first < transitions; ++first) {
    for (int count = 1; first + count <= transitions; ++count) {
      Episode part = PartOf(world_, episode_, first, count);
      EXPECT_TRUE(IsPartOf(part, episode_)) << first << " " << count;
      part.first_transition += first + count < transitions ? 1 : -1;
      EXPECT_FALSE(IsPartOf(part, episode_)) << first << " " << count;
    }
  }
  EXPECT_FALSE(IsPartOf(Episode{}, episode_));
}

TEST_F(EpisodeCheckWithoutMasks, AcceptsFlownEpisodesThatEndEarly) {
  int early = 0;
  for (uint64_t seed = 0; seed < 40; ++seed) {
    const Episode episode = Fly(seed, static_cast<double>(seed % 3) / 2);
    early += episode.outcome == Outcome::kOutOfTime ? 1 : 0;
    EXPECT_TRUE(Accepts(episode)) << seed;
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
  const auto drop_last = [&](Episode& episode, Outcome outcome) {
    episode.states.pop_back();
    episode.actions.pop_back();
    episode.rewards.pop_back();
    episode.td_errors.pop_back();
    episode.next_masks.resize(episode.next_masks.size() - static_cast<size_t>(MaskSize(world_)));
    episode.outcome = outcome;
  };
  ExpectRefused([&](Episode& episode) { drop_last(episode, Outcome::kArrived); }, "without end, arrived", 0);
  ExpectRefused([&](Episode& episode) { drop_last(episode, Outcome::kFlying); }, "without end, flying", 0);
  ExpectRefused(
      [&](Episode& episode) {
        episode.states.erase(episode.states.begin());
        episode.actions.erase(episode.actions.begin());
        episode.rewards.erase(episode.rewards.begin());
        episode.td_errors.erase(episode.td_errors.begin());
        episode.next_masks.erase(episode.next_masks.begin(), episode.next_masks.begin() + MaskSize(world_));
      },
      "without beginning", 0);
  EXPECT_FALSE(Accepts(Episode{}));
}

TEST_F(EpisodeCheck, RefusesATransitionAfterTheEnd) {
  ExpectRefused(
      [&](Episode& episode) {
        episode.states.push_back(episode.states.back());
        episode.actions.push_back(static_cast<int16_t>(world_.ActionIndex({Move::kHover, 0})));
        episode.rewards.push_back(episode.rewards.back());
        episode.td_errors.push_back(0);
        episode.next_masks.resize(episode.next_masks.size() + static_cast<size_t>(MaskSize(world_)), 0xff);
      },
      "after the end", 0);
}

}  // namespace
}  // namespace fresco
