// Who is to fly what, and when it is announced.
#include "tests/learner/roster_fixture.h"

namespace fresco {
namespace {

class RosterTest : public RosterFixture {};

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

}  // namespace
}  // namespace fresco
