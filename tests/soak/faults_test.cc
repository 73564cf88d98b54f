// The faults of a soak depend on the seed and the round only.
#include "soak/faults.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace fresco {
namespace {

std::vector<Fault> Drawn(uint64_t seed, int round, int actors, int count) {
  FaultPlan plan(seed, round, actors);
  std::vector<Fault> faults;
  for (int i = 0; i < count; ++i) {
    faults.push_back(plan.Next());
  }
  return faults;
}

TEST(FaultPlan, IsTheSameForTheSameSeedAndRound) {
  EXPECT_EQ(Drawn(7, 3, 2, 200), Drawn(7, 3, 2, 200));
  EXPECT_EQ(ToText(FaultPlan(7, 3, 2).disturbance()), ToText(FaultPlan(7, 3, 2).disturbance()));
}

TEST(FaultPlan, IsAnotherOneForAnotherSeedOrRound) {
  EXPECT_NE(Drawn(7, 3, 2, 20), Drawn(8, 3, 2, 20));
  EXPECT_NE(Drawn(7, 3, 2, 20), Drawn(7, 4, 2, 20));
  EXPECT_NE(ToText(FaultPlan(7, 3, 2).disturbance()), ToText(FaultPlan(7, 4, 2).disturbance()));
}

TEST(FaultPlan, HasEveryKindOnceInFiveFaults) {
  for (uint64_t seed = 0; seed < 50; ++seed) {
    std::map<FaultKind, int> counts;
    for (const Fault& fault : Drawn(seed, 1, 3, 25)) {
      ++counts[fault.kind];
    }
    ASSERT_EQ(counts.size(), kFaultKinds.size());
    for (const auto& [kind, count] : counts) {
      EXPECT_EQ(count, 5) << FaultKindName(kind);
    }
  }
}

TEST(FaultPlan, HasTheKindsInManyOrders) {
  std::set<std::vector<FaultKind>> orders;
  for (uint64_t seed = 0; seed < 1000; ++seed) {
    std::vector<FaultKind> kinds;
    for (const Fault& fault : Drawn(seed, 1, 1, 5)) {
      kinds.push_back(fault.kind);
    }
    orders.insert(kinds);
  }
  EXPECT_GT(orders.size(), 115u);  // of 120; a thousand draws leave out 0.03 of them on average
}

TEST(FaultPlan, LetsFaultsFollowOneAnotherAtItsGaps) {
  int64_t before_us = 0;
  for (const Fault& fault : Drawn(1, 1, 2, 1000)) {
    EXPECT_GE(fault.at_us - before_us, FaultPlan::kShortestGapUs);
    EXPECT_LE(fault.at_us - before_us, FaultPlan::kLongestGapUs);
    before_us = fault.at_us;
  }
}

TEST(FaultPlan, NamesActorsThatAreThereAndTimesWithinTheirBounds) {
  std::set<int> actors;
  for (const Fault& fault : Drawn(2, 5, 3, 1000)) {
    const bool of_an_actor = fault.kind == FaultKind::kKillActor || fault.kind == FaultKind::kStopActor;
    ASSERT_EQ(fault.actor >= 0, of_an_actor);
    ASSERT_LT(fault.actor, 3);
    actors.insert(fault.actor);
    const bool kills = fault.kind == FaultKind::kKillActor || fault.kind == FaultKind::kKillLearner;
    ASSERT_EQ(fault.duration_us == 0, kills) << FaultKindName(fault.kind);
    ASSERT_LE(fault.duration_us, fault.kind == FaultKind::kStopLearner ? 1'000'000 : 3'000'000);
  }
  EXPECT_EQ(actors, (std::set<int>{-1, 0, 1, 2}));
}

TEST(FaultPlan, DisturbsMessagesSoThatARunCanStillGoOn) {
  for (int round = 1; round <= 200; ++round) {
    const LossOptions disturbance = FaultPlan(1, round, 2).disturbance();
    EXPECT_LE(disturbance.drop, 0.05);
    EXPECT_LE(disturbance.duplicate, 0.05);
    EXPECT_LE(disturbance.delay, 0.1);
    EXPECT_LE(disturbance.corrupt, 0.01);
    EXPECT_GT(disturbance.drop, 0);
  }
}

}  // namespace
}  // namespace fresco
