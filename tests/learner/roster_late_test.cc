// What the roster does with orders whose result is late, and what it tells people who wait.
#include <map>

#include "tests/learner/roster_fixture.h"

namespace fresco {
namespace {

class RosterLate : public RosterFixture {
 protected:
  /// The actors are heard of at `now_us` before asking.
  std::vector<order_t> DueWith(std::initializer_list<int64_t> actors, int64_t now_us) {
    for (const int64_t actor : actors) {
      Hear(actor, now_us);
    }
    return Due(now_us);
  }
};

// The usual latency begins as 250 ms; late is what takes four times as long.
TEST_F(RosterLate, OrdersAreAskedForAgainOfAnotherActorWithAHigherAttempt) {
  Write(2);
  const std::vector<order_t> first = DueWith({1, 2}, kBeginUs);
  ASSERT_EQ(first.size(), 2u);
  EXPECT_NE(first[0].actor_id, first[1].actor_id);
  const std::vector<order_t> before = DueWith({1, 2}, kBeginUs + 1'000'000);
  EXPECT_EQ(CountOf(before, 1, 0) + CountOf(before, 2, 0), 2);
  const std::vector<order_t> late = DueWith({1, 2}, kBeginUs + 1'000'001);
  ASSERT_EQ(late.size(), 2u);
  for (size_t index = 0; index < 2; ++index) {
    EXPECT_EQ(late[index].index, first[index].index);
    EXPECT_EQ(late[index].actor_id, 3 - first[index].actor_id);
    EXPECT_EQ(late[index].attempt, 1);
  }
  EXPECT_EQ(roster_.late_orders(), 2);
}

TEST_F(RosterLate, OrdersAreAskedForAgainOfTheOnlyActor) {
  Write(1);
  DueWith({1}, kBeginUs);
  EXPECT_EQ(CountOf(DueWith({1}, kBeginUs + 1'000'001), 1, 1), 1);
  EXPECT_EQ(roster_.late_orders(), 1);
}

TEST_F(RosterLate, PatienceGrowsWithEveryAttempt) {
  Write(1);
  DueWith({1}, kBeginUs);
  std::map<int32_t, int64_t> first_asked_ms;  // by attempt
  for (int64_t ms = 0; ms <= 60'000; ms += 10) {
    for (const order_t& order : DueWith({1}, kBeginUs + ms * 1000)) {
      first_asked_ms.try_emplace(order.attempt, ms);
    }
  }
  // After 1, 2, .. 8 s, and no longer than 8; found at the next 10 ms.
  int64_t expected_ms = 0;
  for (int32_t attempt = 1; expected_ms + 10 + 1000 * std::min(attempt, 8) <= 60'000; ++attempt) {
    expected_ms += 1000 * std::min(attempt, 8) + 10;
    EXPECT_EQ(first_asked_ms.at(attempt), expected_ms) << attempt;
  }
}

TEST_F(RosterLate, PatienceFollowsTheUsualLatencyButIsNeverUnder150Milliseconds) {
  Write(100);
  DueWith({1}, kBeginUs);
  for (int64_t index = 0; index < 100; ++index) {
    Complete(index, kBeginUs + 2000);  // 2 ms each: the average is far below 150 / 4 ms
  }
  Write(1);
  DueWith({1}, kBeginUs + 10'000);
  EXPECT_EQ(CountOf(DueWith({1}, kBeginUs + 160'000), 1, 0), 1);
  EXPECT_EQ(CountOf(DueWith({1}, kBeginUs + 160'001), 1, 1), 1);
}

TEST_F(RosterLate, PatienceBecomesLongerWhereFlightsAreLong) {
  Write(100);
  DueWith({1}, kBeginUs);
  for (int64_t index = 0; index < 100; ++index) {
    Complete(index, kBeginUs + 900'000);  // the average: nearly 0.9 s, late after nearly 3.6 s
  }
  Write(1);
  const int64_t assigned_us = kBeginUs + 1'000'000;
  DueWith({1}, assigned_us);
  EXPECT_EQ(CountOf(DueWith({1}, assigned_us + 3'500'000), 1, 0), 1);
  EXPECT_EQ(CountOf(DueWith({1}, assigned_us + 3'600'000), 1, 1), 1);
}

TEST_F(RosterLate, ResultsOfAnEarlierAttemptCount) {
  Write(1);
  DueWith({1}, kBeginUs);
  DueWith({1, 2}, kBeginUs + 1'000'001);
  Complete(0, kBeginUs + 1'000'500);  // whoever it came from
  EXPECT_TRUE(DueWith({1, 2}, kBeginUs + 9'000'000).empty());
  roster_.Completed(0, kBeginUs + 9'000'000);   // once more
  roster_.Completed(55, kBeginUs + 9'000'000);  // and one that was never assigned
  Write(8);
  const std::vector<order_t> due = DueWith({1, 2}, kBeginUs + 9'000'000);
  EXPECT_EQ(CountOf(due, 1, 0), 4);  // neither has anything else to do
  EXPECT_EQ(CountOf(due, 2, 0), 4);
}

TEST_F(RosterLate, ActorsWhoseOrdersWentToAnotherHaveRoomAgain) {
  Write(4);
  DueWith({1}, kBeginUs);
  EXPECT_EQ(CountOf(DueWith({2}, kBeginUs + 400'000), 2, 1), 4);
  Write(4);
  EXPECT_EQ(CountOf(DueWith({1}, kBeginUs + 401'000), 1, 0), 4);
}

TEST_F(RosterLate, AwaitedNamesTheActorTheOrderAndTheTime) {
  Write(1);
  EXPECT_EQ(roster_.Awaited(0, kBeginUs), "an actor to join");
  Hear(4, kBeginUs);
  EXPECT_EQ(roster_.Awaited(0, kBeginUs), "an actor for order 0");
  Due(kBeginUs);
  EXPECT_EQ(roster_.Awaited(0, kBeginUs), "host-4 (pid 1004): order 0 for 0.0 s");
  EXPECT_EQ(roster_.Awaited(0, kBeginUs + 300'000), "host-4 (pid 1004): order 0 for 0.3 s");
  EXPECT_EQ(roster_.Awaited(0, kBeginUs + 350'001), "an actor for order 0");  // host-4 is silent
  EXPECT_EQ(roster_.Awaited(17, kBeginUs), "an actor for order 17");
  Due(kBeginUs + 3'000'001);
  EXPECT_EQ(roster_.Awaited(0, kBeginUs + 3'000'001), "an actor to join");
}

TEST_F(RosterLate, AwaitedCountsFromTheLastTimeThatTheOrderWasAskedFor) {
  Write(1);
  DueWith({4}, kBeginUs);
  DueWith({4, 5}, kBeginUs + 1'000'001);
  EXPECT_EQ(roster_.Awaited(0, kBeginUs + 1'200'001), "host-5 (pid 1005): order 0 for 0.2 s");
}

}  // namespace
}  // namespace fresco
