// A flyer in CartPole: the order's seed decides where the episode begins, and an episode that was cut off has
// a value in its last state.
#include <gtest/gtest.h>

#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "core/error.h"
#include "tests/nn/literal_network.h"
#include "tests/support/error_of.h"
#include "tests/training/acting_samples.h"
#include "tests/training/literal_run.h"

namespace fresco {
namespace {

constexpr int kCartPoleOrders = 80;
constexpr int kMaximumSteps = 12;
constexpr double kCartPoleDiscount = 0.99;  // CartPole's, which the configuration does not set

/// Q(s, .) with the observation computed once more.
Doubles ValuesIn(const Experiment& experiment, const Vector& parameters, std::span<const float> state) {
  const Doubles input = {static_cast<double>(state[0]) / 2.4, static_cast<double>(state[1]) / 2,
                         static_cast<double>(state[2]) / (12 * std::numbers::pi / 180),
                         static_cast<double>(state[3]) / 2};
  const Doubles wide(parameters.data(), parameters.data() + parameters.size());
  return LiteralForward(experiment.network()->layer_sizes(), wide, input);
}

size_t Larger(const Doubles& values) {
  return values[1] > values[0] ? 1 : 0;
}

class FlyerOfCartPole : public ::testing::TestWithParam<bool> {
 protected:
  FlightPlan Plan(int index) const {
    const auto number = static_cast<uint32_t>(index);
    return PlanOf(experiment_, index, (index % 5) / 4.0, number, 100 + number);
  }

  Experiment experiment_ = SmallCartPole({{"agent.double_dqn", GetParam() ? "true" : "false"}});
};

TEST_P(FlyerOfCartPole, SendsErrorsThatBootstrapUnlessTheEpisodeIsTerminal) {
  std::set<Ending> endings;
  for (int index = 0; index < kCartPoleOrders; ++index) {
    const FlightPlan plan = Plan(index);
    const OrderResult result = FlyAlone(experiment_, plan);
    const Episode& episode = result.episode;
    endings.insert(episode.ending);
    ASSERT_EQ(result.td_errors.size(), episode.actions.size());
    for (size_t i = 0; i < episode.actions.size(); ++i) {
      const Doubles values = ValuesIn(experiment_, *plan.current, episode.state(i));
      double y = 1;
      if (i + 1 < episode.actions.size() || episode.ending == Ending::kTruncated) {
        const Doubles target = ValuesIn(experiment_, *plan.target, episode.state(i + 1));
        const Doubles current = ValuesIn(experiment_, *plan.current, episode.state(i + 1));
        y += kCartPoleDiscount * target[Larger(GetParam() ? current : target)];
      }
      EXPECT_NEAR(result.td_errors[i], y - values[static_cast<size_t>(episode.actions[i])], 1e-5)
          << index << ", " << i;
    }
  }
  EXPECT_EQ(endings, (std::set{Ending::kTerminal, Ending::kTruncated}));
}

TEST_P(FlyerOfCartPole, BeginsWhereTheSeedSays) {
  std::set<std::vector<float>> starts;
  for (int index = 0; index < kCartPoleOrders; ++index) {
    FlightPlan plan = Plan(index);
    const OrderResult result = FlyAlone(experiment_, plan);
    EXPECT_EQ(result.seed, plan.order.seed);
    RandomStream stream(plan.order.seed, RandomPurpose::kEpisodeStart, 0, 0);
    std::vector<float> start(4);
    for (float& field : start) {
      field = static_cast<float>(0.05 * (2 * stream.NextUniform() - 1));
    }
    EXPECT_EQ(std::vector(result.episode.states.begin(), result.episode.states.begin() + 4), start);
    starts.insert(start);
    plan.order.index += kCartPoleOrders;
    plan.order.kind = OrderKind::kEvaluate;
    EXPECT_TRUE(SameBits(FlyAlone(experiment_, plan).episode, result.episode));
  }
  EXPECT_EQ(starts.size(), static_cast<size_t>(kCartPoleOrders));
}

/// Without places there are no excursions: a draw whether to explore, and one of an action.
TEST_P(FlyerOfCartPole, ExploresByTheDrawsOfEachStep) {
  for (int index = 0; index < kCartPoleOrders; ++index) {
    const FlightPlan plan = Plan(index);
    const Episode episode = FlyAlone(experiment_, plan).episode;
    for (size_t i = 0; i < episode.actions.size(); ++i) {
      RandomStream stream(plan.order.seed, RandomPurpose::kActing, static_cast<uint32_t>(i) + 1, 0);
      const bool explores = stream.NextUniform() < plan.order.epsilon;
      const Doubles values = ValuesIn(experiment_, *plan.current, episode.state(i));
      if (explores) {
        EXPECT_EQ(episode.actions[i], static_cast<int>(stream.NextBelow(2))) << index << ", " << i;
      } else if (std::abs(values[0] - values[1]) > 1e-5) {
        EXPECT_EQ(episode.actions[i], static_cast<int>(Larger(values))) << index << ", " << i;
      }
    }
  }
}

TEST_P(FlyerOfCartPole, GivesAnEpisodeTheSameBitsInAnyCompany) {
  std::vector<FlightPlan> plans;
  for (int index = 0; index < kCartPoleOrders; ++index) {
    plans.push_back(PlanOf(experiment_, index, (index % 5) / 4.0));
  }
  for (const int per_slot : {1, 3, kCartPoleOrders}) {
    const auto together = FlyTogether(experiment_, 20, plans, per_slot);
    for (const FlightPlan& plan : plans) {
      EXPECT_TRUE(SameBits(together.at(plan.order.index), FlyAlone(experiment_, plan))) << plan.order.index;
    }
  }
}

TEST_P(FlyerOfCartPole, KeepsItsPlaceUntilTheLastErrorIsKnown) {
  for (int index = 0; index < kCartPoleOrders; ++index) {
    const FlightPlan plan = Plan(index);
    Flyer flyer(experiment_, 1);
    flyer.Start(plan.order, plan.current, plan.target);
    int steps = 0;
    OrderResult flown;
    for (; !flyer.Idle(); ++steps) {
      EXPECT_FALSE(flyer.HasRoom());
      flyer.Step([&](const Order&, const OrderResult& result) { flown = result; });
    }
    EXPECT_EQ(steps, flown.episode.transitions() + (flown.episode.ending == Ending::kTruncated ? 1 : 0));
    EXPECT_EQ(flown.episode.ending == Ending::kTruncated,
              flown.episode.transitions() == kMaximumSteps && flown.episode.ending != Ending::kTerminal);
  }
}

TEST_P(FlyerOfCartPole, FliesGreedilyFromTheStartOfTheSeed) {
  std::set<std::vector<float>> flights;
  for (int index = 0; index < 20; ++index) {
    FlightPlan plan = PlanOf(experiment_, index, 0, 7, 7);
    const Episode episode = FlyGreedily(experiment_, plan.order.seed, plan.current);
    EXPECT_TRUE(SameBits(episode, FlyAlone(experiment_, plan).episode));
    flights.insert(episode.states);
  }
  EXPECT_EQ(flights.size(), 20u);
}

INSTANTIATE_TEST_SUITE_P(PlainAndDouble, FlyerOfCartPole, ::testing::Bool());

TEST(FlyerOfAWorldWithoutPlaces, IsNeverToldToMakeExcursions) {
  const std::string error = ErrorOf(
      [] {
        SmallCartPole({{"schedule.excursion_share", "0.5"}});
      },
      ErrorKind::kUsage);
  EXPECT_NE(error.find("schedule.excursion_share: 0.5"), std::string::npos) << error;
}

}  // namespace
}  // namespace fresco
