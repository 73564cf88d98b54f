// Acrobot against Lagrange's equations of two links, solved as a linear system and integrated by a generic
// Runge-Kutta method; these against the law of energy; and the rules by hand.
#include "worlds/acrobot/acrobot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "tests/support/allocation_count.h"
#include "tests/worlds/play.h"

namespace fresco {
namespace {

using testing::ElementsAre;
using testing::FloatEq;

constexpr double kPi = std::numbers::pi;

/// y' = f(y) by the fourth-order Runge-Kutta method, for as many equations as there are.
template <size_t N, class Function>
std::array<double, N> RungeKutta(std::array<double, N> y, double step, Function f) {
  const std::array<double, 4> reach = {0, 0.5, 0.5, 1}, weight = {1. / 6, 1. / 3, 1. / 3, 1. / 6};
  std::array<double, N> k{}, sum = y;
  for (size_t stage = 0; stage < 4; ++stage) {
    std::array<double, N> at = y;
    for (size_t i = 0; i < N; ++i) {
      at[i] += step * reach[stage] * k[i];
    }
    k = f(at);
    for (size_t i = 0; i < N; ++i) {
      sum[i] += step * weight[stage] * k[i];
    }
  }
  return sum;
}

/// Lagrange's equations M(q) q'' = (0, torque) - C(q, q') - G(q) of two links of 1 kg and 1 m, with the
/// centre of mass in the middle and an inertia of 1 kg m^2 about it.
Acrobot::State LagrangeRates(const Acrobot::State& state, double torque) {
  const auto [q1, q2, v1, v2] = state;
  const double m11 = 3.5 + std::cos(q2), m12 = 1.25 + std::cos(q2) / 2, m22 = 1.25;
  const double c1 = -std::sin(q2) * (v1 * v2 + v2 * v2 / 2), c2 = std::sin(q2) * v1 * v1 / 2;
  const double g2 = 4.9 * std::sin(q1 + q2), g1 = 14.7 * std::sin(q1) + g2;
  const double right1 = -c1 - g1, right2 = torque - c2 - g2;
  const double determinant = m11 * m22 - m12 * m12;
  return {v1, v2, (right1 * m22 - m12 * right2) / determinant, (m11 * right2 - m12 * right1) / determinant};
}

double WrapByHand(double angle) {
  while (angle > kPi) {
    angle -= 2 * kPi;
  }
  while (angle < -kPi) {
    angle += 2 * kPi;
  }
  return angle;
}

Acrobot::State LiteralAcrobot(const Acrobot::State& state, double torque) {
  const Acrobot::State next =
      RungeKutta(state, 0.2, [torque](const Acrobot::State& s) { return LagrangeRates(s, torque); });
  return {WrapByHand(next[0]), WrapByHand(next[1]), std::max(-4 * kPi, std::min(next[2], 4 * kPi)),
          std::max(-9 * kPi, std::min(next[3], 9 * kPi))};
}

/// How far apart two states are in their worst field; angles the short way round.
double Difference(std::span<const float> found, const Acrobot::State& expected) {
  double largest = 0;
  for (size_t field = 0; field < 4; ++field) {
    const double difference = found[field] - expected[field];
    largest = std::max(largest, std::abs(field < 2 ? WrapByHand(difference) : difference));
  }
  return largest;
}

/// Height of the free end over the fixed joint, from the positions of the joints.
double LiteralHeight(const Acrobot::State& state) {
  const double middle = std::sin(state[0] - kPi / 2);
  return middle + std::sin(state[0] + state[1] - kPi / 2);
}

Acrobot::State LiteralAcrobotStart(uint64_t seed) {
  RandomStream stream(seed, RandomPurpose::kEpisodeStart, 0, 0);
  Acrobot::State start;
  for (double& field : start) {
    field = -0.1 + stream.NextUniform() / 5;
  }
  return start;
}

/// Turns the second link against the swing of the first. This swings the free end up in about 100 steps.
int Pump(std::span<const float> state) {
  return state[2] > 0 ? 0 : 2;
}

int NoTorque(std::span<const float>) {
  return 1;
}

TEST(Acrobot, DescribesItself) {
  const Acrobot world(500);
  const WorldDescription& description = world.description();
  EXPECT_EQ(description.name, "acrobot");
  EXPECT_EQ(world.state_size(), 4);
  EXPECT_EQ(world.observation_size(), 6);
  EXPECT_THAT(description.actions, ElementsAre("torque -1", "no torque", "torque +1"));
  EXPECT_EQ(world.longest_episode(), 500);
  EXPECT_EQ(description.discount, 0.99);
  EXPECT_TRUE(description.random);
  EXPECT_TRUE(description.repeatable);
  EXPECT_FALSE(description.less_is_better);
  EXPECT_FALSE(world.has_places());
}

// The motor's power is all that changes the energy, so this checks the equations that the others check
// against.
TEST(LiteralAcrobot, ChangesItsEnergyByTheMotorsPower) {
  RandomStream stream(1, RandomPurpose::kTest, 0, 0);
  // Energy from the velocities of the centres of mass and their heights.
  const auto energy = [](const Acrobot::State& s) {
    const double x1 = s[2] * std::cos(s[0]) / 2, y1 = s[2] * std::sin(s[0]) / 2, turn2 = s[2] + s[3];
    const double x2 = 2 * x1 + turn2 * std::cos(s[0] + s[1]) / 2;
    const double y2 = 2 * y1 + turn2 * std::sin(s[0] + s[1]) / 2;
    const double heights = -std::cos(s[0]) / 2 - std::cos(s[0]) - std::cos(s[0] + s[1]) / 2;
    return (x1 * x1 + y1 * y1 + x2 * x2 + y2 * y2 + s[2] * s[2] + turn2 * turn2) / 2 + 9.8 * heights;
  };
  for (int i = 0; i < 1000; ++i) {
    Acrobot::State state;
    for (double& field : state) {
      field = 6 * stream.NextUniform() - 3;
    }
    const double torque = 2 * stream.NextUniform() - 1;
    const double step = 1e-5;
    const auto rates = [torque](const Acrobot::State& s) { return LagrangeRates(s, torque); };
    const double power =
        (energy(RungeKutta(state, step, rates)) - energy(RungeKutta(state, -step, rates))) / (2 * step);
    ASSERT_NEAR(power, torque * state[3], 1e-5);
  }
}

TEST(Acrobot, FollowsLagrangeFromAnyState) {
  RandomStream stream(1, RandomPurpose::kTest, 0, 0);
  int limited = 0, wrapped = 0;
  for (int i = 0; i < 20'000; ++i) {
    const double fastest = i % 2 == 0 ? 1.0 / 4 : 1;
    const auto draw = [&stream](double largest) { return largest * (2 * stream.NextUniform() - 1); };
    Acrobot::State state;
    state = {draw(kPi), draw(kPi), draw(4 * kPi * fastest), draw(9 * kPi * fastest)};
    const double torque = stream.NextBelow(3) - 1.0;
    const Acrobot::State expected = LiteralAcrobot(state, torque);
    const Acrobot::State found = Acrobot::After(state, torque);
    for (size_t field = 0; field < found.size(); ++field) {
      ASSERT_NEAR(found[field], expected[field], 1e-9 * fastest) << "field " << field;
    }
    ASSERT_LE(std::abs(found[0]), kPi);
    ASSERT_LE(std::abs(found[1]), kPi);
    limited += std::abs(found[2]) == 4 * kPi || std::abs(found[3]) == 9 * kPi;
    wrapped += std::abs(found[0] - state[0]) > kPi;
  }
  EXPECT_GT(limited, 100);
  EXPECT_GT(wrapped, 100);
}

TEST(Acrobot, FollowsLagrangeStepByStepInRandomEpisodes) {
  constexpr size_t kCompared = 150;  // later, rounding decides: the motion is chaotic
  const Acrobot world(500);
  for (uint64_t seed = 0; seed < 200; ++seed) {
    const Episode episode = Play(world, seed, RandomActions(seed, 3));
    Acrobot::State state = LiteralAcrobotStart(seed);
    for (size_t i = 0; i <= std::min(episode.actions.size(), kCompared); ++i) {
      ASSERT_LE(Difference(episode.state(i), state), 1e-5) << "seed " << seed << ", state " << i;
      if (i < episode.actions.size()) {
        state = LiteralAcrobot(state, episode.actions[i] - 1);
      }
    }
  }
}

TEST(Acrobot, FollowsLagrangeAndItsRulesInWholeEpisodes) {
  const Acrobot world(500);
  int terminal = 0, truncated = 0;
  for (uint64_t seed = 0; seed < 200; ++seed) {
    const Episode episode = Play(world, seed, seed % 2 == 0 ? Rule(Pump) : RandomActions(seed, 3));
    for (size_t i = 0; i < episode.actions.size(); ++i) {
      const auto from = episode.state(i);
      const Acrobot::State next =
          LiteralAcrobot({from[0], from[1], from[2], from[3]}, episode.actions[i] - 1);
      ASSERT_LE(Difference(episode.state(i + 1), next), 1e-5) << "seed " << seed << ", step " << i;
      const bool last = i + 1 == episode.actions.size();
      const bool up = LiteralHeight(next) > 1;
      ASSERT_EQ(episode.rewards[i], up ? 0 : -1);
      ASSERT_EQ(last, up || i + 1 == 500);
      if (last) {
        ASSERT_EQ(episode.ending, up ? Ending::kTerminal : Ending::kTruncated);
        ++(up ? terminal : truncated);
      }
    }
  }
  EXPECT_GE(terminal, 50);
  EXPECT_GE(truncated, 50);
}

TEST(Acrobot, StartsUniformlyAndBySeed) {
  const Acrobot world(500);
  constexpr int kSeeds = 20'000;
  std::array<double, 4> sum{}, sum_of_squares{};
  std::set<std::vector<float>> starts;
  for (uint64_t seed = 0; seed < kSeeds; ++seed) {
    const EpisodeRecorder recorder(world, seed);
    starts.insert({recorder.state().begin(), recorder.state().end()});
    for (size_t field = 0; field < 4; ++field) {
      const double value = recorder.state()[field];
      ASSERT_LE(std::abs(recorder.state()[field]), 0.1f);
      sum[field] += value;
      sum_of_squares[field] += value * value;
    }
  }
  EXPECT_EQ(starts.size(), size_t{kSeeds});
  for (size_t field = 0; field < 4; ++field) {
    // Of a uniform number in (-0.1, 0.1): mean 0, variance 0.2^2 / 12. The mean of 20,000 has a deviation of
    // 0.0004.
    EXPECT_NEAR(sum[field] / kSeeds, 0, 0.002);
    EXPECT_NEAR(sum_of_squares[field] / kSeeds, 0.04 / 12, 0.0001);
  }
}

TEST(Acrobot, RepeatsAnEpisodeToTheBit) {
  const Acrobot world(500);
  for (uint64_t seed = 0; seed < 10; ++seed) {
    const Episode episode = Play(world, seed, RandomActions(seed, 3));
    Episode again;
    ASSERT_TRUE(FlyActions(world, seed, episode.actions, again));
    EXPECT_TRUE(SameBits(again, episode));
    EXPECT_EQ(again.states, episode.states);
  }
}

TEST(Acrobot, AnEnvironmentStartsAfreshWithEachReset) {
  const Acrobot world(20);
  const Episode episode = Play(world, 3, Pump);
  const auto environment = world.NewEnvironment();
  environment->Reset(4);
  environment->Step(0);
  environment->Reset(3);
  std::vector<float> state(4);
  for (size_t i = 0; i < episode.actions.size(); ++i) {
    environment->WriteState(state);
    ASSERT_TRUE(std::equal(state.begin(), state.end(), episode.state(i).begin()));
    ASSERT_EQ(environment->Step(episode.actions[i]).ending, i == 19 ? Ending::kTruncated : Ending::kNone);
  }
}

TEST(Acrobot, RestsWhereItHangs) {
  EXPECT_THAT(Acrobot::After({0, 0, 0, 0}, 0), ElementsAre(0, 0, 0, 0));
}

// The highest point is 2 m up, and 1 m is the height of the goal.
TEST(Acrobot, IsUpIfTheFreeEndIsOverOneMetre) {
  EXPECT_FALSE(Acrobot::IsUp({0, 0, 0, 0}));
  EXPECT_TRUE(Acrobot::IsUp({kPi, 0, 0, 0}));
  EXPECT_FALSE(Acrobot::IsUp({kPi, kPi, 0, 0}));      // folded: the end is at the joint
  EXPECT_FALSE(Acrobot::IsUp({kPi / 2, 1.5, 0, 0}));  // sin(1.5) = 0.997 m
  EXPECT_TRUE(Acrobot::IsUp({kPi / 2 + 0.01, 1.5, 0, 0}));
  // Straight, 120 degrees from hanging down: each link rises by half a metre.
  EXPECT_FALSE(Acrobot::IsUp({kPi * 2 / 3 - 1e-9, 0, 0, 0}));
  EXPECT_TRUE(Acrobot::IsUp({kPi * 2 / 3 + 1e-9, 0, 0, 0}));
  EXPECT_TRUE(Acrobot::IsUp({-kPi * 2 / 3 - 1e-9, 0, 9, 9}));
}

TEST(Acrobot, TruncatesAfterTheMaximumOfStepsButTheGoalWins) {
  const Episode swing = Play(Acrobot(500), 1, Pump);
  ASSERT_EQ(swing.ending, Ending::kTerminal);
  EXPECT_EQ(swing.rewards.back(), 0);
  const int steps = swing.transitions();
  const Episode same = Play(Acrobot(steps), 1, Pump);
  EXPECT_EQ(same.ending, Ending::kTerminal);
  EXPECT_EQ(same.rewards, swing.rewards);
  const Episode shorter = Play(Acrobot(steps - 1), 1, Pump);
  EXPECT_EQ(shorter.ending, Ending::kTruncated);
  EXPECT_EQ(shorter.transitions(), steps - 1);
  EXPECT_EQ(shorter.rewards.back(), -1);
}

TEST(Acrobot, JudgesByTheReturn) {
  const Acrobot world(400);
  std::vector<double> figures(1);
  const Episode swing = Play(world, 2, Pump);
  world.Judge(swing, figures);
  EXPECT_EQ(figures[0], 1 - swing.transitions());
  EXPECT_TRUE(world.Succeeded(swing));
  const Episode rest = Play(world, 2, NoTorque);
  world.Judge(rest, figures);
  EXPECT_EQ(figures[0], -400);
  EXPECT_FALSE(world.Succeeded(rest));
}

TEST(Acrobot, ObservesDirectionsAndVelocitiesInUnitsOfTheirLimits) {
  const Acrobot world(500);
  std::vector<float> observation(6);
  world.Observe(std::vector<float>{0, 1.04719755f, 3.14159265f, -14.1371669f}, observation);
  EXPECT_THAT(observation,
              ElementsAre(1, 0, FloatEq(0.5f), FloatEq(0.8660254f), FloatEq(0.25f), FloatEq(-0.5f)));
  world.Observe(std::vector<float>{-0.64350111f, 2.21429744f, -12.5663706f, 28.2743339f}, observation);
  EXPECT_THAT(observation, ElementsAre(FloatEq(0.8f), FloatEq(-0.6f), FloatEq(-0.6f), FloatEq(0.8f),
                                       FloatEq(-1), FloatEq(1)));
}

TEST(Acrobot, AllowsAllActions) {
  const Acrobot world(500);
  const EpisodeRecorder recorder(world, 1);
  EXPECT_THAT(recorder.mask(), ElementsAre(1, 1, 1));
}

TEST(AcrobotDeathTest, RefusesWhatIsNoStep) {
  const Acrobot world(1);
  const auto environment = world.NewEnvironment();
  environment->Reset(1);
  EXPECT_DEATH(environment->Step(3), "action");
  EXPECT_DEATH(environment->Step(-1), "action");
  environment->Step(2);
  EXPECT_DEATH(environment->Step(2), "ending");
}

#ifndef FRESCO_SANITIZED

TEST(Acrobot, DoesNotAllocateOnceConstructed) {
  const Acrobot world(500);
  const int64_t at_first = AllocationCount();
  const auto environment = world.NewEnvironment();
  std::array<float, 4> state;
  std::array<float, 6> observation;
  std::array<uint8_t, 3> mask;
  const int64_t before = AllocationCount();
  EXPECT_GT(before, at_first);
  for (uint64_t seed = 0; seed < 3; ++seed) {
    environment->Reset(seed);
    for (Ending ending = Ending::kNone; ending == Ending::kNone;) {
      environment->WriteState(state);
      environment->WriteMask(mask);
      world.Observe(state, observation);
      ending = environment->Step(Pump(state)).ending;
    }
  }
  EXPECT_EQ(AllocationCount(), before);
}

#endif

}  // namespace
}  // namespace fresco
