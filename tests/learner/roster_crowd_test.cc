// Many actors, actors that come and go, and statuses that are old or forged.
#include <map>

#include "tests/learner/roster_fixture.h"

namespace fresco {
namespace {

using Hearing = Roster::Hearing;

class RosterCrowd : public RosterFixture {
 protected:
  static constexpr int64_t kActors = 200;

  void HearAll(int64_t now_us) {
    for (int64_t actor = 1; actor <= kActors; ++actor) {
      Hear(actor, now_us);
    }
  }
};

TEST_F(RosterCrowd, OfTwoHundredThatJoinAtOnceAllGetTheSame) {
  Write(3 * kActors);
  HearAll(kBeginUs);
  std::map<int64_t, int> orders;
  for (const order_t& order : Due(kBeginUs)) {
    ++orders[order.actor_id];
  }
  EXPECT_EQ(orders.size(), static_cast<size_t>(kActors));
  for (const auto& [actor, count] : orders) {
    EXPECT_EQ(count, 3) << actor;
  }
}

TEST_F(RosterCrowd, TakesTurnsWhereThereAreFewerOrdersThanActors) {
  std::map<int64_t, int> orders;
  HearAll(kBeginUs);
  for (int64_t ms = 0; ms < 100; ++ms) {
    Write(8);
    for (const order_t& order : Due(kBeginUs + ms * 1000)) {
      ++orders[order.actor_id];
      Complete(order.index, kBeginUs + ms * 1000, order.actor_id);
    }
    while (ledger_.TakeNext()) {
    }
  }
  EXPECT_EQ(orders.size(), static_cast<size_t>(kActors));
  for (const auto& [actor, count] : orders) {
    EXPECT_EQ(count, 4) << actor;  // of 800
  }
}

TEST_F(RosterCrowd, StatusesThatAreNotNewerThanTheLastOneKeepNobodyAlive) {
  actor_status_t status = StatusOf(1);
  status.sequence = 7;
  EXPECT_EQ(roster_.Hear(status, kBeginUs), Hearing::kHeard);
  for (const int64_t old : {7, 6, 0, -1}) {
    status.sequence = old;
    EXPECT_EQ(roster_.Hear(status, kBeginUs + 300'000), Hearing::kStale) << old;
  }
  Write(1);
  EXPECT_TRUE(Due(kBeginUs + 350'001).empty());
  EXPECT_EQ(roster_.Hear(status, kBeginUs + 60'000'000), Hearing::kStale);  // however long it is gone
  EXPECT_EQ(roster_.live_actors(kBeginUs + 60'000'000), 0);
  status.sequence = 8;
  EXPECT_EQ(roster_.Hear(status, kBeginUs + 60'000'000), Hearing::kHeard);
  EXPECT_EQ(roster_.live_actors(kBeginUs + 60'000'000), 1);
  EXPECT_EQ(Due(kBeginUs + 60'000'000).size(), 1u);
}

TEST_F(RosterCrowd, FurtherActorsAreIgnoredWhileTooManyAreThere) {
  Hear(1, kBeginUs);
  for (int64_t forged = 2; forged < 10'000; ++forged) {
    const bool room = forged <= static_cast<int64_t>(Roster::kMaximumActors);
    EXPECT_EQ(Hear(forged, kBeginUs), room ? Hearing::kHeard : Hearing::kCrowdedOut);
  }
  EXPECT_EQ(Hear(1, kBeginUs + 100'000), Hearing::kHeard);
  EXPECT_EQ(roster_.live_actors(kBeginUs + 100'000), static_cast<int>(Roster::kMaximumActors));
}

TEST_F(RosterCrowd, ThoseThatAreGoneMakeRoomTheLongestGoneFirst) {
  for (int64_t actor = 1; actor <= static_cast<int64_t>(Roster::kMaximumActors); ++actor) {
    Hear(actor, kBeginUs + actor);
  }
  actor_status_t second = StatusOf(2);
  EXPECT_EQ(Hear(9999, kBeginUs + 3'000'001), Hearing::kCrowdedOut);  // the first is gone in a moment
  EXPECT_EQ(Hear(9999, kBeginUs + 3'000'002), Hearing::kHeard);
  EXPECT_EQ(roster_.Hear(second, kBeginUs + 3'000'002), Hearing::kStale);  // the second is remembered
}

TEST_F(RosterCrowd, OrdersOfAnActorThatHadToMakeRoomGoToAnother) {
  Write(2);
  Hear(1, kBeginUs);
  EXPECT_EQ(CountOf(Due(kBeginUs), 1, 0), 2);
  for (int64_t actor = 2; actor <= static_cast<int64_t>(Roster::kMaximumActors) + 1; ++actor) {
    Hear(actor, kBeginUs + 4'000'000);
  }
  EXPECT_EQ(Hear(1, kBeginUs + 4'000'000), Hearing::kCrowdedOut);
  const std::vector<order_t> due = Due(kBeginUs + 4'000'000);
  EXPECT_EQ(due.size(), 2u);
  EXPECT_EQ(CountOf(due, 1, 0), 0);
  Complete(0, kBeginUs + 4'001'000, 1);
  Complete(1, kBeginUs + 4'001'000, due[1].actor_id);
  EXPECT_TRUE(Due(kBeginUs + 4'100'000).empty());
}

}  // namespace
}  // namespace fresco
