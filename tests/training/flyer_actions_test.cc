// Which actions a flyer takes: greedy ones against a slow literal network, random ones by their
// frequencies (bounds of five standard deviations; the draws are the same every time).
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <string>

#include "tests/training/literal_flight.h"

namespace fresco {
namespace {

int Allowed(const Mask& mask) {
  return std::accumulate(mask.begin(), mask.end(), 0);
}

struct ActionVariant {
  bool masks;
  bool sensor_geometry;
};

Settings SettingsOf(const ActionVariant& variant) {
  Settings settings = variant.masks ? WithMasks() : Settings{};
  settings.emplace_back("agent.sensor_geometry", variant.sensor_geometry ? "true" : "false");
  return settings;
}

class FlyerActions : public ::testing::TestWithParam<ActionVariant> {
 protected:
  FlightPlan Plan(int64_t index, double epsilon, uint32_t network = 1) const {
    return PlanOf(experiment_, index, epsilon, network);
  }

  /// Episodes of so many orders.
  std::vector<Episode> FlyMany(int orders, double epsilon) const {
    std::vector<FlightPlan> plans(static_cast<size_t>(orders), Plan(0, epsilon));
    for (size_t index = 0; index < plans.size(); ++index) {
      plans[index].order = TrainOrder(static_cast<int64_t>(index), epsilon);
    }
    std::vector<Episode> episodes;
    for (auto& [index, result] : FlyTogether(experiment_, 64, plans, 64)) {
      episodes.push_back(std::move(result.episode));
    }
    return episodes;
  }

  Experiment experiment_ = SmallField(SettingsOf(GetParam()));
  const UavWorld& world_ = RequireUavWorld(experiment_.world(), "the test");
};

TEST_P(FlyerActions, AreTheLiteralArgmaxAmongAllowedOnesOfAGreedyOrder) {
  int decisive = 0;
  for (uint32_t network = 0; network < 60; ++network) {
    const FlightPlan plan = Plan(network, 0, network);
    const Episode episode = FlyAlone(experiment_, plan).episode;
    const auto masks = MasksOf(experiment_, episode);
    for (size_t i = 0; i < episode.actions.size(); ++i) {
      const Doubles values = LiteralValues(experiment_, *plan.current, StateIn(episode, i));
      if (Lead(values, masks[i]) > kValueRounding) {
        ++decisive;
        EXPECT_EQ(episode.actions[i], LiteralArgmax(values, masks[i])) << network << ", " << i;
      }
    }
  }
  EXPECT_GT(decisive, 150);
}

TEST_P(FlyerActions, AreTheFirstAllowedOneWhereAllValuesAreEqual) {
  FlightPlan plan = Plan(0, 0);
  plan.current = std::make_shared<const Vector>(Vector::Zero(plan.current->size()));
  const Episode episode = FlyAlone(experiment_, plan).episode;
  const auto masks = MasksOf(experiment_, episode);
  for (size_t i = 0; i < episode.actions.size(); ++i) {
    EXPECT_EQ(episode.actions[i], std::find(masks[i].begin(), masks[i].end(), 1) - masks[i].begin());
  }
}

TEST_P(FlyerActions, AreUniformAmongAllowedOnesInTheFirstSlotWithEpsilonOne) {
  constexpr int kOrders = 5000;
  std::vector<int> taken(static_cast<size_t>(world_.actions()));
  const std::vector<Episode> episodes = FlyMany(kOrders, 1);
  for (const Episode& episode : episodes) {
    ++taken[static_cast<size_t>(episode.actions[0])];
  }
  const Mask mask = MasksOf(experiment_, episodes[0])[0];  // every episode begins alike
  const double share = 1.0 / Allowed(mask);
  for (size_t action = 0; action < taken.size(); ++action) {
    const double expected = mask[action] != 0 ? kOrders * share : 0;
    EXPECT_NEAR(taken[action], expected, kDeviations * std::sqrt(expected * (1 - share))) << action;
  }
}

TEST_P(FlyerActions, AreUniformAmongAllowedOnesInLaterSlotsWithEpsilonOne) {
  double surplus = 0;  // of the action's number among the allowed ones over its mean
  double variance = 0;
  for (const Episode& episode : FlyMany(1000, 1)) {
    const auto masks = MasksOf(experiment_, episode);
    for (size_t i = 1; i < episode.actions.size(); ++i) {
      const int allowed = Allowed(masks[i]);
      ASSERT_EQ(masks[i][static_cast<size_t>(episode.actions[i])], 1);
      surplus += std::accumulate(masks[i].begin(), masks[i].begin() + episode.actions[i], 0);
      surplus -= (allowed - 1) / 2.0;
      variance += (allowed * allowed - 1) / 12.0;
    }
  }
  EXPECT_GT(variance, 1000);
  EXPECT_LT(std::abs(surplus), kDeviations * std::sqrt(variance));
}

TEST_P(FlyerActions, DepartFromTheArgmaxAsOftenAsEpsilonSays) {
  constexpr double kEpsilon = 0.3;
  const SharedParameters parameters = Plan(0, 0).current;
  double surplus = 0;
  double variance = 0;
  for (const Episode& episode : FlyMany(400, kEpsilon)) {
    const auto masks = MasksOf(experiment_, episode);
    for (size_t i = 0; i < episode.actions.size(); ++i) {
      const Doubles values = LiteralValues(experiment_, *parameters, StateIn(episode, i));
      const double departs = kEpsilon * (1 - 1.0 / Allowed(masks[i]));
      surplus += (episode.actions[i] != LiteralArgmax(values, masks[i])) - departs;
      variance += departs * (1 - departs);
    }
  }
  EXPECT_GT(variance, 100);
  EXPECT_LT(std::abs(surplus), kDeviations * std::sqrt(variance));
}

TEST_P(FlyerActions, OfFlyGreedilyAreThoseOfAnyOrderWithEpsilonZero) {
  for (uint32_t network = 0; network < 20; ++network) {
    FlightPlan plan = Plan(network, 0, network);
    plan.target = plan.current;
    plan.order.seed = network;
    const Episode ordered = FlyAlone(experiment_, plan).episode;
    EXPECT_TRUE(SameBits(FlyGreedily(experiment_, plan.order.seed, plan.current), ordered)) << network;
  }
}

INSTANTIATE_TEST_SUITE_P(Options, FlyerActions,
                         ::testing::Values(ActionVariant{false, false}, ActionVariant{true, false},
                                           ActionVariant{true, true}),
                         [](const auto& instance) {
                           return std::string(instance.param.masks ? "Masked" : "Free") +
                                  (instance.param.sensor_geometry ? "WithGeometry" : "");
                         });

}  // namespace
}  // namespace fresco
