// CartPole against Newton's two equations of cart and pole, solved as a linear system, against steps that
// Gymnasium's documentation publishes, and its rules by hand.
#include "worlds/cartpole/cartpole.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "tests/support/allocation_count.h"
#include "tests/worlds/facts.h"
#include "tests/worlds/play.h"

namespace fresco {
namespace {

using testing::ElementsAre;
using testing::FloatEq;

/// The equations of motion before anybody solved them for the accelerations:
///   (cart + pole) x'' + pole l cos(a) a'' = F + pole l a'^2 sin(a)
///   cos(a) x'' + 4/3 l a'' = g sin(a)
CartPole::State LiteralCartPole(const CartPole::State& state, double force_n) {
  const double cart = 1, pole = 0.1, l = 0.5, g = 9.8;
  const double a = state[2], turn = state[3];
  const double m11 = cart + pole, m12 = pole * l * std::cos(a),
               right1 = force_n + pole * l * turn * turn * std::sin(a);
  const double m21 = std::cos(a), m22 = 4 * l / 3, right2 = g * std::sin(a);
  const double determinant = m11 * m22 - m12 * m21;
  const double x_acceleration = (right1 * m22 - m12 * right2) / determinant;
  const double a_acceleration = (m11 * right2 - m21 * right1) / determinant;
  return {state[0] + state[1] / 50, state[1] + x_acceleration / 50, a + turn / 50,
          turn + a_acceleration / 50};
}

double LiteralForce(int action) {
  return action == 0 ? -10 : 10;
}

/// Keeps the pole upright and brings the cart to `goal_m`.
Rule BalanceAt(float goal_m) {
  return [goal_m](std::span<const float> s) {
    return 0.1f * std::clamp(s[0] - goal_m, -1.0f, 1.0f) + 0.2f * s[1] + 2 * s[2] + 0.6f * s[3] > 0 ? 1 : 0;
  };
}

CartPole::State StateOf(std::span<const float> floats) {
  return {floats[0], floats[1], floats[2], floats[3]};
}

CartPole::State LiteralStart(uint64_t seed) {
  RandomStream stream(seed, RandomPurpose::kEpisodeStart, 0, 0);
  CartPole::State start;
  for (double& field : start) {
    field = -0.05 + stream.NextUniform() / 10;
  }
  return start;
}

bool LiteralFall(const CartPole::State& state) {
  const double degrees = state[2] * 180 / std::numbers::pi;
  return state[0] < -2.4 || state[0] > 2.4 || degrees < -12 || degrees > 12;
}

TEST(CartPole, DescribesItself) {
  const CartPole world(500);
  const WorldDescription& description = world.description();
  EXPECT_EQ(description.name, "cartpole");
  EXPECT_EQ(world.state_size(), 4);
  EXPECT_EQ(world.observation_size(), 4);
  EXPECT_THAT(description.actions, ElementsAre("push left", "push right"));
  EXPECT_EQ(world.longest_episode(), 500);
  EXPECT_EQ(CartPole(7).longest_episode(), 7);
  EXPECT_EQ(description.discount, 0.99);
  EXPECT_TRUE(description.random);
  EXPECT_TRUE(description.repeatable);
  EXPECT_FALSE(description.less_is_better);
  EXPECT_FALSE(world.has_places());
}

// The example of gymnasium.Env's vector.make: three carts with seed 42, pushed right, left, right.
TEST(CartPole, StepsAsGymnasiumsDocumentationDoes) {
  const std::array<CartPole::State, 3> before = {{{0.0273956, -0.00611216, 0.03585979, 0.0197368},
                                                  {0.01522993, -0.04562247, -0.04799704, 0.03392126},
                                                  {-0.03774345, -0.02418869, -0.00942293, 0.0469184}}};
  const std::array<CartPole::State, 3> after = {{{0.02727336, 0.18847767, 0.03625453, -0.26141977},
                                                 {0.01431748, -0.24002443, -0.04731862, 0.3110827},
                                                 {-0.03822722, 0.1710671, -0.00848456, -0.2487226}}};
  for (size_t cart = 0; cart < before.size(); ++cart) {
    const CartPole::State found = CartPole::After(before[cart], cart == 1 ? -10 : 10);
    for (size_t field = 0; field < found.size(); ++field) {
      EXPECT_NEAR(found[field], after[cart][field], 3e-8) << "cart " << cart << ", field " << field;
    }
  }
}

TEST(CartPole, FollowsNewtonFromAnyState) {
  RandomStream stream(1, RandomPurpose::kTest, 0, 0);
  for (int i = 0; i < 10'000; ++i) {
    CartPole::State state;
    for (double& field : state) {
      field = 6 * stream.NextUniform() - 3;
    }
    const double force_n = 20 * stream.NextUniform() - 10;
    const CartPole::State expected = LiteralCartPole(state, force_n);
    const CartPole::State found = CartPole::After(state, force_n);
    for (size_t field = 0; field < found.size(); ++field) {
      ASSERT_NEAR(found[field], expected[field], 1e-13) << "field " << field;
    }
  }
}

TEST(CartPole, FollowsNewtonStepByStepInRandomEpisodes) {
  const CartPole world(500);
  for (uint64_t seed = 0; seed < 500; ++seed) {
    const Episode episode = Play(world, seed, RandomActions(seed, 2));
    CartPole::State state = LiteralStart(seed);
    for (size_t i = 0;; ++i) {
      for (size_t field = 0; field < state.size(); ++field) {
        ASSERT_NEAR(episode.state(i)[field], state[field], 1e-6) << "seed " << seed << ", state " << i;
      }
      if (i == episode.actions.size()) {
        break;
      }
      ASSERT_FALSE(LiteralFall(state)) << "seed " << seed << ", state " << i;
      ASSERT_EQ(episode.rewards[i], 1);
      state = LiteralCartPole(state, LiteralForce(episode.actions[i]));
    }
    ASSERT_TRUE(LiteralFall(state));
    ASSERT_EQ(episode.ending, Ending::kTerminal);
  }
}

// Errors double every nine steps, so in long episodes each step is compared from the recorded state.
TEST(CartPole, FollowsNewtonInLongEpisodes) {
  const CartPole world(500);
  for (uint64_t seed = 0; seed < 50; ++seed) {
    const Episode episode = Play(world, seed, BalanceAt(0.1f * static_cast<float>(seed % 10)));
    ASSERT_EQ(episode.transitions(), 500) << "seed " << seed;
    for (size_t i = 0; i < episode.actions.size(); ++i) {
      const CartPole::State next =
          LiteralCartPole(StateOf(episode.state(i)), LiteralForce(episode.actions[i]));
      for (size_t field = 0; field < next.size(); ++field) {
        ASSERT_NEAR(episode.state(i + 1)[field], next[field], 1e-6) << "seed " << seed << ", step " << i;
      }
    }
  }
}

TEST(CartPole, StartsUniformlyAndBySeed) {
  const CartPole world(500);
  constexpr int kSeeds = 20'000;
  std::array<double, 4> sum{}, sum_of_squares{};
  std::set<std::vector<float>> starts;
  for (uint64_t seed = 0; seed < kSeeds; ++seed) {
    const EpisodeRecorder recorder(world, seed);
    starts.insert({recorder.state().begin(), recorder.state().end()});
    for (size_t field = 0; field < 4; ++field) {
      const double value = recorder.state()[field];
      ASSERT_LE(std::abs(value), 0.05);
      sum[field] += value;
      sum_of_squares[field] += value * value;
    }
  }
  EXPECT_EQ(starts.size(), size_t{kSeeds});
  for (size_t field = 0; field < 4; ++field) {
    // Of a uniform number in (-0.05, 0.05): mean 0, variance 0.1^2 / 12. The mean of 20,000 has a deviation
    // of 0.0002.
    EXPECT_NEAR(sum[field] / kSeeds, 0, 0.001);
    EXPECT_NEAR(sum_of_squares[field] / kSeeds, 0.01 / 12, 0.00002);
  }
}

TEST(CartPole, RepeatsAnEpisodeToTheBit) {
  const CartPole world(500);
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const Episode episode = Play(world, seed, RandomActions(seed, 2));
    Episode again;
    ASSERT_TRUE(FlyActions(world, seed, episode.actions, again));
    EXPECT_EQ(again.states, episode.states);
    EXPECT_TRUE(SameBits(again, episode));
  }
}

TEST(CartPole, AnEnvironmentStartsAfreshWithEachReset) {
  const CartPole world(500);
  const Episode episode = Play(world, 3, RandomActions(3, 2));
  const auto environment = world.NewEnvironment();
  for (const int steps : {0, 5}) {
    environment->Reset(4);
    for (int step = 0; step < steps; ++step) {
      environment->Step(0);
    }
  }
  environment->Reset(3);
  std::vector<float> state(4);
  for (size_t i = 0; i < episode.actions.size(); ++i) {
    ASSERT_EQ(environment->Step(episode.actions[i]).terminal(), i + 1 == episode.actions.size());
    environment->WriteState(state);
    ASSERT_TRUE(std::equal(state.begin(), state.end(), episode.state(i + 1).begin()));
  }
}

TEST(CartPole, FailsBeyondItsLimits) {
  EXPECT_FALSE(CartPole::HasFailed({0, 1000, 0, 1000}));
  EXPECT_FALSE(CartPole::HasFailed({2.4, 0, 0, 0}));
  EXPECT_FALSE(CartPole::HasFailed({-2.4, 0, 0, 0}));
  EXPECT_TRUE(CartPole::HasFailed({std::nextafter(2.4, 3), 0, 0, 0}));
  EXPECT_TRUE(CartPole::HasFailed({std::nextafter(-2.4, -3), 0, 0, 0}));
  EXPECT_NEAR(CartPole::kMaximumAngleRad, 0.2094395102393195, 1e-16);
  EXPECT_FALSE(CartPole::HasFailed({0, 0, CartPole::kMaximumAngleRad, 0}));
  EXPECT_FALSE(CartPole::HasFailed({0, 0, -CartPole::kMaximumAngleRad, 0}));
  EXPECT_TRUE(CartPole::HasFailed({0, 0, std::nextafter(CartPole::kMaximumAngleRad, 1), 0}));
  EXPECT_TRUE(CartPole::HasFailed({0, 0, std::nextafter(-CartPole::kMaximumAngleRad, -1), 0}));
}

TEST(CartPole, EndsWithAPoleThatFallsOrACartOffTheTrack) {
  const CartPole world(500);
  const Episode fall = Play(world, 1, [](std::span<const float>) { return 1; });
  EXPECT_EQ(fall.ending, Ending::kTerminal);
  EXPECT_LT(fall.state(fall.actions.size())[2], -0.2094f);  // the cart runs away under it
  EXPECT_LT(std::abs(fall.state(fall.actions.size())[0]), 2.4f);
  for (const float goal_m : {-6.0f, 6.0f}) {
    const Episode off_track = Play(world, 1, BalanceAt(goal_m));
    const size_t last = off_track.actions.size();
    EXPECT_EQ(off_track.ending, Ending::kTerminal);
    EXPECT_GT(off_track.state(last)[0] * goal_m, 2.4f * 6);
    EXPECT_LE(std::abs(off_track.state(last - 1)[0]), 2.4f);
    EXPECT_LT(std::abs(off_track.state(last)[2]), 0.2f);
    EXPECT_FALSE(world.Succeeded(off_track));
  }
}

TEST(CartPole, TruncatesAfterTheMaximumOfStepsButAFallWins) {
  const Episode fall = Play(CartPole(500), 5, RandomActions(5, 2));
  ASSERT_EQ(fall.ending, Ending::kTerminal);
  const int steps = fall.transitions();
  const Episode same = Play(CartPole(steps), 5, RandomActions(5, 2));
  EXPECT_EQ(same.ending, Ending::kTerminal);
  EXPECT_EQ(same.states, fall.states);
  const Episode shorter = Play(CartPole(steps - 1), 5, RandomActions(5, 2));
  EXPECT_EQ(shorter.ending, Ending::kTruncated);
  EXPECT_EQ(shorter.transitions(), steps - 1);
  const Episode one = Play(CartPole(1), 5, RandomActions(5, 2));
  EXPECT_EQ(one.ending, Ending::kTruncated);
  EXPECT_EQ(one.transitions(), 1);
}

TEST(CartPole, JudgesByTheReturn) {
  const CartPole world(100);
  std::vector<double> figures(1);
  const Episode balanced = Play(world, 2, BalanceAt(0));
  world.Judge(balanced, figures);
  EXPECT_EQ(figures[0], 100);
  EXPECT_TRUE(world.Succeeded(balanced));
  const Episode fall = Play(world, 2, [](std::span<const float>) { return 0; });
  world.Judge(fall, figures);
  EXPECT_EQ(figures[0], fall.transitions());
  EXPECT_LT(figures[0], 20);
  EXPECT_FALSE(world.Succeeded(fall));
}

TEST(CartPole, ObservesInUnitsOfAboutOne) {
  const CartPole world(500);
  std::vector<float> observation(4);
  world.Observe(std::vector<float>{2.4f, -2, 0.20943951f, 1}, observation);
  EXPECT_THAT(observation, ElementsAre(FloatEq(1), FloatEq(-1), FloatEq(1), FloatEq(0.5f)));
  world.Observe(std::vector<float>{-0.6f, 3, -0.05235988f, -7}, observation);
  EXPECT_THAT(observation, ElementsAre(FloatEq(-0.25f), FloatEq(1.5f), FloatEq(-0.25f), FloatEq(-3.5f)));
}

TEST(CartPole, AllowsBothActions) {
  const CartPole world(500);
  const EpisodeRecorder recorder(world, 1);
  EXPECT_THAT(recorder.mask(), ElementsAre(1, 1));
}

TEST(CartPoleDeathTest, RefusesWhatIsNoStep) {
  const CartPole world(1);
  const auto environment = world.NewEnvironment();
  environment->Reset(1);
  EXPECT_DEATH(environment->Step(2), "action");
  EXPECT_DEATH(environment->Step(-1), "action");
  environment->Step(1);
  EXPECT_DEATH(environment->Step(1), "ending");
}

#ifndef FRESCO_SANITIZED

TEST(CartPole, DoesNotAllocateOnceConstructed) {
  const CartPole world(500);
  const int64_t at_first = AllocationCount();
  const auto environment = world.NewEnvironment();
  std::array<float, 4> state, observation;
  std::array<uint8_t, 2> mask;
  const int64_t before = AllocationCount();
  EXPECT_GT(before, at_first);
  for (uint64_t seed = 0; seed < 3; ++seed) {
    environment->Reset(seed);
    for (Ending ending = Ending::kNone; ending == Ending::kNone;) {
      ending = environment->Step(1).ending;
      environment->WriteState(state);
      environment->WriteMask(mask);
      world.Observe(state, observation);
    }
  }
  EXPECT_EQ(AllocationCount(), before);
}

#endif

TEST(Return, IsTheSumOfTheRewardsInDouble) {
  Episode episode;
  EXPECT_EQ(Return(episode), 0);
  episode.rewards = {1e8f, 1, -1e8f, 0.5f};
  EXPECT_EQ(Return(episode), 1.5);
}

TEST(CartPole, IsToldStepByStep) {
  const CartPole world(7);
  const Episode episode = Play(world, 3, [](std::span<const float>) { return 1; });
  const EpisodeAccount account = world.Tell(episode);
  EXPECT_EQ(account.sentence, "balanced; return 7.000");
  EXPECT_THAT(account.facts,
              ElementsAre(IsFact("balanced", true), IsFact("steps", int64_t{7}), IsFact("return", 7.0)));
  EXPECT_THAT(account.columns,
              ElementsAre("step", "position", "velocity", "angle", "angular_velocity", "action", "reward"));
  ASSERT_EQ(account.steps.size(), 8);
  for (size_t i = 0; i < 8; ++i) {
    ASSERT_EQ(account.steps[i].size(), 7);
    EXPECT_EQ(account.steps[i][0], AccountValue(static_cast<int64_t>(i)));
    for (size_t field = 0; field < 4; ++field) {
      EXPECT_EQ(account.steps[i][1 + field], AccountValue(double{episode.state(i)[field]}));
    }
    EXPECT_EQ(account.steps[i][5], i < 7 ? AccountValue("push right") : AccountValue());
    EXPECT_EQ(account.steps[i][6], i < 7 ? AccountValue(1.0) : AccountValue());
  }
}

}  // namespace
}  // namespace fresco
