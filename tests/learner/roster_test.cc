// Who is to fly what, and when it is announced; what the roster tells people who wait, and whoever asks for
// its state.
#include "tests/learner/roster_fixture.h"

namespace fresco {
namespace {

class RosterTest : public RosterFixture {};

TEST_F(RosterTest, GivesAnActorTwoOrdersForEachOfItsEnvironmentsAndKeepsTheOthersForThoseWhoJoin) {
  Write(20);
  Hear(1, kBeginUs, 4);
  EXPECT_EQ(CountOf(Due(kBeginUs), 1, 0), 8);
  EXPECT_TRUE(Due(kBeginUs + 1000).empty());
  Complete(0, kBeginUs + 2000, 1);
  const std::vector<order_t> next = Due(kBeginUs + 2000);
  ASSERT_EQ(next.size(), 1u);
  EXPECT_EQ(next[0].index, 8);
  Hear(2, kBeginUs + 3000, 3);
  const std::vector<order_t> joined = Due(kBeginUs + 3000);
  EXPECT_EQ(joined.size(), 6u);
  EXPECT_EQ(CountOf(joined, 2, 0), 6);
}

TEST_F(RosterTest, AssignsNothingBeforeAnActorIsThere) {
  Write(3);
  EXPECT_TRUE(Due(kBeginUs).empty());
  EXPECT_EQ(roster_.live_actors(kBeginUs), 0);
  Hear(1, kBeginUs + 10);
  EXPECT_EQ(CountOf(Due(kBeginUs + 10), 1, 0), 3);
  EXPECT_EQ(roster_.live_actors(kBeginUs + 10), 1);
  EXPECT_EQ(roster_.late_orders(), 0);
}

TEST_F(RosterTest, AnnouncesOrdersAsTheyWereWritten) {
  Write(2);
  Hear(7, kBeginUs);
  const std::vector<order_t> due = Due(kBeginUs);
  ASSERT_EQ(due.size(), 2u);
  for (size_t index = 0; index < due.size(); ++index) {
    Order order;
    ASSERT_TRUE(FromWire(due[index], order));
    EXPECT_EQ(order, ledger_.order(static_cast<int64_t>(index)));
    EXPECT_EQ(due[index].actor_id, 7);
  }
}

TEST_F(RosterTest, AssignsByRoom) {
  Write(8);
  Hear(1, kBeginUs, 6);
  Hear(2, kBeginUs, 2);
  const std::vector<order_t> due = Due(kBeginUs);
  EXPECT_EQ(CountOf(due, 1, 0), 6);
  EXPECT_EQ(CountOf(due, 2, 0), 2);
}

TEST_F(RosterTest, AssignsToThoseWhoseOrdersAreDone) {
  Write(8);
  Hear(1, kBeginUs);
  Hear(2, kBeginUs);
  for (const order_t& order : Due(kBeginUs)) {
    if (order.actor_id == 2) {
      Complete(order.index, kBeginUs + 1000);
    }
  }
  Write(3);
  EXPECT_EQ(CountOf(Due(kBeginUs + 2000), 2, 0), 3);
}

TEST_F(RosterTest, RepeatsWhatIsStillOutEverySixtyMilliseconds) {
  Write(4);
  Hear(1, kBeginUs);
  EXPECT_EQ(Due(kBeginUs).size(), 4u);
  EXPECT_TRUE(Due(kBeginUs + 59'999).empty());
  EXPECT_EQ(CountOf(Due(kBeginUs + 60'000), 1, 0), 4);
  EXPECT_TRUE(Due(kBeginUs + 60'001).empty());
  Write(1);
  EXPECT_EQ(Due(kBeginUs + 60'002).size(), 1u);  // what is new, at once
  EXPECT_EQ(CountOf(Due(kBeginUs + 120'000), 1, 0), 4);
}

TEST_F(RosterTest, AnnouncesNothingThatIsComplete) {
  Write(4);
  Hear(1, kBeginUs);
  Due(kBeginUs);
  Complete(0, kBeginUs + 1000);
  Complete(2, kBeginUs + 1000);
  ledger_.TakeNext();
  const std::vector<order_t> due = Due(kBeginUs + 60'000);
  ASSERT_EQ(due.size(), 2u);
  EXPECT_EQ(due[0].index, 1);
  EXPECT_EQ(due[1].index, 3);
  Complete(1, kBeginUs + 61'000);
  Complete(3, kBeginUs + 61'000);
  EXPECT_TRUE(Due(kBeginUs + 300'000).empty());
}

TEST_F(RosterTest, GivesTheOrdersOfASilentActorToAnother) {
  Write(4);
  Hear(1, kBeginUs);
  Hear(2, kBeginUs);
  EXPECT_EQ(CountOf(Due(kBeginUs), 1, 0), 2);
  Hear(2, kBeginUs + 300'000);
  EXPECT_EQ(CountOf(Due(kBeginUs + 350'000), 1, 0), 2);
  const std::vector<order_t> due = Due(kBeginUs + 350'001);
  EXPECT_EQ(due.size(), 2u);
  EXPECT_EQ(CountOf(due, 2, 1), 2);
  EXPECT_EQ(roster_.late_orders(), 2);
  EXPECT_EQ(roster_.live_actors(kBeginUs + 350'001), 2);
}

TEST_F(RosterTest, KeepsTheOrdersOfASilentActorWhereThereIsNoOther) {
  Write(2);
  Hear(1, kBeginUs);
  Due(kBeginUs);
  EXPECT_TRUE(Due(kBeginUs + 400'000).empty());
  Hear(1, kBeginUs + 500'000);
  EXPECT_EQ(CountOf(Due(kBeginUs + 500'000), 1, 0), 2);
  EXPECT_EQ(roster_.late_orders(), 0);
}

TEST_F(RosterTest, CountsAnActorAsGoneAfterThreeSeconds) {
  Write(1);
  Hear(1, kBeginUs);
  EXPECT_EQ(roster_.live_actors(kBeginUs + 3'000'000), 1);
  EXPECT_EQ(roster_.live_actors(kBeginUs + 3'000'001), 0);
  Hear(2, kBeginUs + 4'000'000);
  EXPECT_EQ(CountOf(Due(kBeginUs + 4'000'000), 2, 0) + CountOf(Due(kBeginUs + 4'060'000), 2, 1), 1);
}

class RosterReport : public RosterFixture {
 protected:
  RosterReport() { Write(1); }

  std::string Awaited(int64_t now_us) const { return roster_.Awaited(ledger_.order(0), now_us); }

  /// Actor 4 with order 0, after a status that says this of it.
  void HearOfOrder(int64_t oldest_open, const std::vector<chunk_range_t>& missing) {
    Hear(4, kBeginUs);
    Due(kBeginUs);
    actor_status_t status = StatusOf(4);
    status.oldest_open_order = oldest_open;
    status.missing = missing;
    status.missing_count = static_cast<int32_t>(missing.size());
    Hear(status, kBeginUs + 200'000);
  }

  static chunk_range_t Missing(NetworkKind kind, int32_t version, int32_t first, int32_t count) {
    return ChunkRange({kind, version}, first, count);
  }
};

TEST_F(RosterReport, SaysThatNobodyIsThere) {
  EXPECT_EQ(Awaited(kBeginUs), "an actor to join");
}

TEST_F(RosterReport, SaysThatAnOrderIsNobodysYet) {
  Hear(4, kBeginUs);
  EXPECT_EQ(Awaited(kBeginUs), "an actor for order 0");
}

TEST_F(RosterReport, SaysSinceWhenAllAreSilent) {
  Hear(4, kBeginUs);
  Due(kBeginUs);
  EXPECT_EQ(Awaited(kBeginUs + 400'000), "an actor: host-4 (pid 1004) was last heard of 0.4 s ago");
  Hear(5, kBeginUs + 1'000'000);
  EXPECT_EQ(Awaited(kBeginUs + 61'000'000),
            "an actor: all 2 are silent, host-5 (pid 1005) was last heard of 60.0 s ago");
}

TEST_F(RosterReport, SaysThatTheOrderIsInFlight) {
  HearOfOrder(0, {});
  EXPECT_EQ(Awaited(kBeginUs + 300'000),
            "host-4 (pid 1004): order 0 for 0.3 s; it has the order and is flying");
}

TEST_F(RosterReport, SaysThatTheOrderOrItsResultIsOnTheWay) {
  HearOfOrder(-1, {});
  EXPECT_EQ(
      Awaited(kBeginUs + 300'000),
      "host-4 (pid 1004): order 0 for 0.3 s; it has not got the order yet, or the result has not arrived");
}

TEST_F(RosterReport, SaysWhichNetworkTheActorLacks) {
  HearOfOrder(0, {Missing(NetworkKind::kCurrent, 3, 0, 4), Missing(NetworkKind::kCurrent, 3, 9, 1),
                  Missing(NetworkKind::kCurrent, 2, 0, 50), Missing(NetworkKind::kTarget, 3, 0, 60)});
  EXPECT_EQ(Awaited(kBeginUs + 300'000),
            "host-4 (pid 1004): order 0 for 0.3 s; it lacks current network 3 (5 chunks missing)");
}

TEST_F(RosterReport, SaysWhichNetworksTheActorLacks) {
  HearOfOrder(0, {Missing(NetworkKind::kCurrent, 3, 0, 4), Missing(NetworkKind::kTarget, 2, 0, 7)});
  EXPECT_EQ(Awaited(kBeginUs + 300'000),
            "host-4 (pid 1004): order 0 for 0.3 s; it lacks current network 3 (4 chunks missing) and target "
            "network 2 (7 chunks missing)");
}

TEST_F(RosterReport, CountsFromTheLastTimeThatTheOrderWasAskedFor) {
  HearOfOrder(0, {});
  for (const int64_t actor : {4, 5}) {
    Hear(actor, kBeginUs + 1'000'001);
  }
  Due(kBeginUs + 1'000'001);
  EXPECT_EQ(Awaited(kBeginUs + 1'200'001).substr(0, 38), "host-5 (pid 1005): order 0 for 0.2 s; ");
}

TEST_F(RosterReport, ListsActorsWithTheAgeOfTheirStatusAndTheirOrders) {
  Write(2);
  Hear(4, kBeginUs);
  Due(kBeginUs);
  Hear(255, kBeginUs + 500'000);
  EXPECT_EQ(roster_.StateText(kBeginUs + 700'000),
            "\n  actor 0000000000000004 host-4 (pid 1004): heard of 0.7 s ago, 0 transitions/s, 0 late, "
            "orders 0 1 2"
            "\n  actor 00000000000000ff host-255 (pid 1255): heard of 0.2 s ago, 0 transitions/s, 0 late, no "
            "order");
  for (int64_t actor = 1000; actor < 1100; ++actor) {
    Hear(actor, kBeginUs);
  }
  EXPECT_NE(roster_.StateText(kBeginUs).find("\n  and 70 more actors"), std::string::npos);
}

}  // namespace
}  // namespace fresco
