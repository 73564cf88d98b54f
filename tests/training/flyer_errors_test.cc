// The temporal-difference errors that a flyer sends, and whether its episodes are flights of the
// environment.
#include <gtest/gtest.h>

#include <set>

#include "tests/training/literal_flight.h"

namespace fresco {
namespace {

struct ErrorVariant {
  const char* name;
  bool double_dqn;
  bool masks;
};

class FlyerErrors : public ::testing::TestWithParam<ErrorVariant> {
 protected:
  static Experiment ExperimentOf(const ErrorVariant& variant) {
    Settings settings = variant.masks ? WithMasks() : Settings{};
    settings.emplace_back("agent.double_dqn", variant.double_dqn ? "true" : "false");
    return SmallField(settings);
  }

  FlightPlan Plan(int index) const {
    const auto number = static_cast<uint32_t>(index);
    return PlanOf(experiment_, index, (index % 5) / 4.0, number, 100 + number);
  }

  static constexpr int kOrders = 80;
  Experiment experiment_ = ExperimentOf(GetParam());
};

TEST_P(FlyerErrors, AreYMinusQComputedLiterally) {
  for (int index = 0; index < kOrders; ++index) {
    const FlightPlan plan = Plan(index);
    const OrderResult result = FlyAlone(experiment_, plan);
    const Episode& episode = result.episode;
    const auto masks = MasksOf(experiment_, episode);
    ASSERT_EQ(result.td_errors.size(), episode.actions.size());
    for (int i = 0; i < episode.transitions(); ++i) {
      const Mask& next_mask = masks[static_cast<size_t>(i) + 1];
      EXPECT_NEAR(result.td_errors[static_cast<size_t>(i)],
                  LiteralTdError(experiment_, plan, episode, i, next_mask), 1e-5)
          << index << ", " << i;
    }
  }
}

TEST_P(FlyerErrors, OfTerminalTransitionsHaveNoBootstrapWhateverTheOutcome) {
  std::set<Outcome> outcomes;
  for (int index = 0; index < kOrders; ++index) {
    const FlightPlan plan = Plan(index);
    const OrderResult result = FlyAlone(experiment_, plan);
    const Episode& episode = result.episode;
    const UavState last = StateIn(episode, episode.actions.size() - 1);
    const Doubles values = LiteralValues(experiment_, *plan.current, last);
    const double value = values[static_cast<size_t>(episode.actions.back())];
    EXPECT_NEAR(result.td_errors.back(), episode.rewards.back() - value, 1e-5);
    outcomes.insert(OutcomeOf(episode));
  }
  const std::set<Outcome> expected =
      GetParam().masks ? std::set{Outcome::kArrived} : std::set{Outcome::kOutOfTime, Outcome::kOutOfEnergy};
  EXPECT_EQ(outcomes, expected);
}

TEST_P(FlyerErrors, AreAllThatTheTargetNetworkChanges) {
  for (int index = 0; index < kOrders; ++index) {
    FlightPlan plan = Plan(index);
    const OrderResult result = FlyAlone(experiment_, plan);
    plan.target = SampleNetwork(experiment_, 1000);
    const OrderResult other = FlyAlone(experiment_, plan);
    EXPECT_EQ(result.td_errors.back(), other.td_errors.back());
    if (result.episode.transitions() > 1) {
      EXPECT_NE(result.td_errors, other.td_errors);
    }
    EXPECT_TRUE(SameBits(result.episode, other.episode));
  }
}

TEST_P(FlyerErrors, BelongToEpisodesThatTheEnvironmentFliesAgain) {
  for (int index = 0; index < kOrders; ++index) {
    const FlightPlan plan = Plan(index);
    const Episode episode = FlyAlone(experiment_, plan).episode;
    const auto masks = MasksOf(experiment_, episode);
    for (size_t i = 0; i < episode.actions.size(); ++i) {
      EXPECT_EQ(masks[i][static_cast<size_t>(episode.actions[i])], 1);
    }
    Episode again;  // what the environment says of these actions: see tests/worlds/episode_test.cc
    ASSERT_TRUE(FlyActions(experiment_.world(), plan.order.seed, episode.actions, again));
    EXPECT_TRUE(SameBits(episode, again));
  }
}

INSTANTIATE_TEST_SUITE_P(Variants, FlyerErrors,
                         ::testing::Values(ErrorVariant{"Plain", false, false},
                                           ErrorVariant{"Double", true, false},
                                           ErrorVariant{"PlainMasked", false, true},
                                           ErrorVariant{"DoubleMasked", true, true}),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace fresco
