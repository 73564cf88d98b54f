// The episode of an order has the same bits whatever it is flown beside.
#include "training/flyer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "core/random.h"
#include "tests/training/acting_samples.h"

namespace fresco {
namespace {

class FlyerTest : public ::testing::Test {
 protected:
  /// Orders 0 .. count - 1 of every epsilon, in turns of these numbers of current and target versions.
  std::vector<FlightPlan> Plans(int count, int current_versions, int target_versions) const {
    const auto network = [&](int number) {
      return SampleNetwork(experiment_, static_cast<uint32_t>(number));
    };
    std::vector<SharedParameters> currents;
    std::vector<SharedParameters> targets;
    std::generate_n(std::back_inserter(currents), current_versions,
                    [&] { return network(static_cast<int>(currents.size())); });
    std::generate_n(std::back_inserter(targets), target_versions,
                    [&] { return network(100 + static_cast<int>(targets.size())); });
    std::vector<FlightPlan> plans;
    for (int index = 0; index < count; ++index) {
      Order order = TrainOrder(index, (index % 5) / 4.0);
      order.current_version = index % current_versions;
      order.target_version = index / 2 % target_versions;
      plans.push_back({order, currents[static_cast<size_t>(order.current_version)],
                       targets[static_cast<size_t>(order.target_version)]});
    }
    return plans;
  }

  void ExpectTheBitsOfEachAlone(const std::vector<FlightPlan>& plans,
                                const std::map<int64_t, OrderResult>& flown) const {
    ASSERT_EQ(flown.size(), plans.size());
    for (const FlightPlan& plan : plans) {
      EXPECT_TRUE(SameBits(flown.at(plan.order.index), FlyAlone(experiment_, plan))) << plan.order.index;
    }
  }

  Experiment experiment_ = SmallField(WithMasks());
};

TEST_F(FlyerTest, GivesAnEpisodeTheSameBitsInAnyCompany) {
  for (const int company : {2, 5, 8, 9, 31}) {
    const auto plans = Plans(company, 1, 1);
    ExpectTheBitsOfEachAlone(plans, FlyTogether(experiment_, company, plans, company));
  }
}

TEST_F(FlyerTest, GivesAnEpisodeTheSameBitsBesideOrdersOfOtherVersions) {
  const auto plans = Plans(40, 3, 2);
  ExpectTheBitsOfEachAlone(plans, FlyTogether(experiment_, 40, plans, 40));
}

TEST_F(FlyerTest, GivesAnEpisodeTheSameBitsBesideOrdersInOtherSlots) {
  const auto plans = Plans(40, 2, 1);
  for (const int per_slot : {1, 3}) {
    ExpectTheBitsOfEachAlone(plans, FlyTogether(experiment_, 40, plans, per_slot));
  }
}

TEST_F(FlyerTest, GivesAnEpisodeTheSameBitsWithAnyCapacity) {
  const auto plans = Plans(20, 1, 1);
  for (const int capacity : {1, 2, 7, 64}) {
    ExpectTheBitsOfEachAlone(plans, FlyTogether(experiment_, capacity, plans, capacity));
  }
}

TEST_F(FlyerTest, GivesAnEpisodeTheSameBitsWhereverItStandsInTheBatch) {
  auto plans = Plans(24, 2, 2);
  RandomStream stream(1, RandomPurpose::kTest, 0, 0);
  for (int trial = 0; trial < 5; ++trial) {
    for (size_t i = plans.size(); i > 1; --i) {
      std::swap(plans[i - 1], plans[stream.NextBelow(static_cast<uint32_t>(i))]);
    }
    ExpectTheBitsOfEachAlone(plans, FlyTogether(experiment_, 24, plans, 6));
  }
}

TEST_F(FlyerTest, GivesAnEpisodeTheSameBitsWhenNetworksOfOneNumberDiffer) {
  auto plans = Plans(12, 1, 1);
  const SharedParameters other = SampleNetwork(experiment_, 9);
  for (size_t i = 0; i < plans.size(); i += 2) {
    plans[i].current = other;
  }
  ExpectTheBitsOfEachAlone(plans, FlyTogether(experiment_, 12, plans, 12));
}

TEST_F(FlyerTest, FliesOtherActionsForAnotherSeedAndTheSameAtAnotherIndex) {
  FlightPlan plan = Plans(1, 1, 1).front();
  plan.order.epsilon = 1;
  std::set<std::vector<int16_t>> flights;
  constexpr int kOrders = 30;
  for (int i = 0; i < kOrders; ++i) {
    FlightPlan other = plan;
    other.order.index = i;
    EXPECT_EQ(FlyAlone(experiment_, other).episode.actions, FlyAlone(experiment_, plan).episode.actions);
    other.order.seed = 1000 + static_cast<uint64_t>(i);
    flights.insert(FlyAlone(experiment_, other).episode.actions);
    other.order.seed = static_cast<uint64_t>(i + 1) << 32;  // the high word counts as well
    flights.insert(FlyAlone(experiment_, other).episode.actions);
  }
  EXPECT_EQ(flights.size(), 2u * kOrders);
}

TEST_F(FlyerTest, TakesNothingFromTheKindAndTheNumbersOfVersions) {
  for (FlightPlan plan : Plans(5, 1, 1)) {
    const OrderResult flown = FlyAlone(experiment_, plan);
    plan.order.kind = OrderKind::kEvaluate;
    plan.order.current_version = 12;
    plan.order.target_version = 4;
    EXPECT_TRUE(SameBits(FlyAlone(experiment_, plan), flown));
  }
}

TEST_F(FlyerTest, KnowsWhatItFliesAndWhetherThereIsRoom) {
  const auto plans = Plans(2, 1, 1);
  Flyer flyer(experiment_, 2);
  EXPECT_TRUE(flyer.Idle());
  for (const FlightPlan& plan : plans) {
    EXPECT_TRUE(flyer.HasRoom());
    EXPECT_FALSE(flyer.IsFlying(plan.order.index));
    flyer.Start(plan.order, plan.current, plan.target);
    EXPECT_TRUE(flyer.IsFlying(plan.order.index));
  }
  EXPECT_FALSE(flyer.HasRoom());
  EXPECT_EQ(flyer.open_flights(), 2);
}

using FlyerDeathTest = FlyerTest;

TEST_F(FlyerDeathTest, RefusesAnOrderWithoutRoomForIt) {
  const FlightPlan plan = Plans(1, 1, 1).front();
  Flyer flyer(experiment_, 1);
  flyer.Start(plan.order, plan.current, plan.target);
  EXPECT_DEATH(flyer.Start(plan.order, plan.current, plan.target), "HasRoom");
}

}  // namespace
}  // namespace fresco
