// Episodes of orders that search: as other orders of this seed before the search, as the beam search says
// behind.
#include <gtest/gtest.h>

#include "tests/training/literal_flight.h"
#include "training/beam_search.h"
#include "training/flyer.h"

namespace fresco {
namespace {

constexpr int kWidth = 6;

class FlyerSearch : public ::testing::TestWithParam<bool> {
 protected:
  FlightPlan PlanWith(int64_t index, double epsilon, int search_from) const {
    FlightPlan plan = PlanOf(experiment_, index, epsilon);
    plan.order.seed = static_cast<uint64_t>(index);
    plan.order.search_width = kWidth;
    plan.order.search_from = search_from;
    return plan;
  }

  /// Sums of rewards from this transition on.
  static double ReturnFrom(const Episode& episode, size_t first) {
    double sum = 0;
    for (size_t i = first; i < episode.rewards.size(); ++i) {
      sum += static_cast<double>(episode.rewards[i]);
    }
    return sum;
  }

  Experiment experiment_ = SmallField({{"agent.safe_action_mask", "true"},
                                       {"agent.coverage_mask", "true"},
                                       {"agent.double_dqn", GetParam() ? "true" : "false"},
                                       {"schedule.excursion_share", "0.5"},
                                       {"schedule.search.width", std::to_string(kWidth)}});
};

TEST_P(FlyerSearch, BeginsAsTheSameOrderWithoutSearch) {
  for (const int from : {0, 1, 5, 12}) {
    const FlightPlan plan = PlanWith(from, 0.8, from);
    FlightPlan without = plan;
    without.order.search_width = 0;
    const Episode searched = FlyAlone(experiment_, plan).episode;
    const Episode explored = FlyAlone(experiment_, without).episode;
    for (size_t i = 0; i < static_cast<size_t>(from); ++i) {
      EXPECT_EQ(searched.actions[i], explored.actions[i]) << from;
    }
  }
}

TEST_P(FlyerSearch, EndsWithWhatTheSearchFindsFromThere) {
  for (const int from : {0, 3, 9}) {
    const FlightPlan plan = PlanWith(from, 0.8, from);
    const Episode flown = FlyAlone(experiment_, plan).episode;
    BeamSearch search(experiment_, kWidth);
    search.Begin(plan.order.seed, plan.current, std::span(flown.actions).first(static_cast<size_t>(from)));
    while (search.Step()) {
    }
    EXPECT_EQ(flown.actions, search.BestActions()) << from;
  }
}

TEST_P(FlyerSearch, FindsTheBestEndingIfAllOfThemFitIntoTheBeam) {
  constexpr int kFrom = 11;  // two of 13 transitions are left, so at most 20 endings are allowed
  const Experiment wide = SmallField({{"agent.safe_action_mask", "true"},
                                      {"agent.coverage_mask", "true"},
                                      {"schedule.search.width", "400"}});
  FlightPlan plan = PlanWith(7, 0.5, kFrom);
  plan.order.search_width = 400;
  const Episode flown = FlyAlone(wide, plan).episode;
  double best = -1e9;
  const auto actions = static_cast<int16_t>(wide.world().actions());
  for (int16_t first = 0; first < actions; ++first) {
    for (int16_t second = 0; second < actions; ++second) {
      std::vector<int16_t> tried(flown.actions.begin(), flown.actions.begin() + kFrom);
      tried.insert(tried.end(), {first, second});
      Episode episode;
      if (FlyActions(wide.world(), plan.order.seed, tried, episode)) {  // both are allowed
        best = std::max(best, ReturnFrom(episode, kFrom));
      }
    }
  }
  EXPECT_NEAR(ReturnFrom(flown, kFrom), best, 1e-6);
}

TEST_P(FlyerSearch, SendsTheErrorsOfEveryTransition) {
  const FlightPlan plan = PlanWith(2, 0.5, 4);
  const OrderResult flown = FlyAlone(experiment_, plan);
  const std::vector<Mask> masks = MasksOf(experiment_, flown.episode);
  ASSERT_EQ(flown.td_errors.size(), flown.episode.actions.size());
  for (int i = 0; i < flown.episode.transitions(); ++i) {
    const auto at = static_cast<size_t>(i);
    EXPECT_NEAR(static_cast<double>(flown.td_errors[at]),
                LiteralTdError(experiment_, plan, flown.episode, i, masks[at + 1]), kValueRounding)
        << i;
  }
}

TEST_P(FlyerSearch, GivesTheSameBitsInAnyCompany) {
  std::vector<FlightPlan> plans;
  for (int index = 0; index < 12; ++index) {
    plans.push_back(PlanWith(index, 0.3, index % 5));
    plans.back().order.search_width = index % 3 == 0 ? 0 : kWidth;
  }
  for (const int per_slot : {1, 4, 12}) {
    const std::map<int64_t, OrderResult> flown = FlyTogether(experiment_, 12, plans, per_slot);
    for (const FlightPlan& plan : plans) {
      EXPECT_TRUE(SameBits(flown.at(plan.order.index), FlyAlone(experiment_, plan))) << plan.order.index;
    }
  }
}

TEST_P(FlyerSearch, ThatBeginsBehindTheEndIsNone) {
  FlightPlan plan = PlanWith(1, 0.3, 13);
  const OrderResult searched = FlyAlone(experiment_, plan);
  plan.order.search_width = 0;
  EXPECT_TRUE(SameBits(searched, FlyAlone(experiment_, plan)));
}

TEST(FlyerSearchDeathTest, RefusesAnotherWidthThanTheSchedules) {
  const Experiment experiment = SmallField({{"schedule.search.width", "6"}});
  FlightPlan plan = PlanOf(experiment, 0, 0.5);
  plan.order.search_width = 7;
  EXPECT_DEATH(FlyAlone(experiment, plan), "search_width");
  const Experiment without = SmallField();
  EXPECT_DEATH(FlyAlone(without, plan), "search_width");
}

INSTANTIATE_TEST_SUITE_P(PlainAndDouble, FlyerSearch, ::testing::Bool());

}  // namespace
}  // namespace fresco
