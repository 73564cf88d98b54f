// What the roster does with orders whose result is late.
#include <map>

#include "core/clock.h"
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
  Hear(1, kBeginUs, 50);  // room for all of them
  ASSERT_EQ(Due(kBeginUs).size(), 100u);
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
  Hear(1, kBeginUs, 50);  // room for all of them
  ASSERT_EQ(Due(kBeginUs).size(), 100u);
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
  roster_.Completed(0, 1, kBeginUs + 9'000'000);   // once more
  roster_.Completed(55, 1, kBeginUs + 9'000'000);  // and one that was never assigned
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

TEST_F(RosterLate, TheHeadOfTheLineIsOrderedTwiceAndTheFirstResultCounts) {
  Write(4);
  const std::vector<order_t> due = DueWith({1, 2}, kBeginUs);
  const int64_t slow = due[0].actor_id;
  for (int64_t index = 1; index < 4; ++index) {
    Complete(index, kBeginUs + 3000, due[static_cast<size_t>(index)].actor_id);
  }
  const std::vector<order_t> again = DueWith({1, 2}, kBeginUs + 900'000);
  ASSERT_EQ(again.size(), 1u);
  EXPECT_EQ(again[0].index, 0);
  EXPECT_EQ(again[0].actor_id, 3 - slow);
  EXPECT_EQ(again[0].attempt, 1);
  Complete(0, kBeginUs + 901'000, slow);
  EXPECT_TRUE(DueWith({1, 2}, kBeginUs + 999'000).empty());
  EXPECT_EQ(roster_.late_orders(), 1);
}

TEST_F(RosterLate, AnActorThatSaysThatItLivesAndSendsNoResultsGetsNoMoreThanAFewOrders) {
  std::map<int64_t, int64_t> sent;  // by actor
  Write(4);
  for (int64_t ms = 0; ms < 5'000; ms += 2) {
    const int64_t now_us = kBeginUs + ms * 1000;
    for (const order_t& order : DueWith({1, 2}, now_us)) {
      ++sent[order.actor_id];
      if (order.actor_id == 1) {  // the other one is deaf
        Complete(order.index, now_us + 1000, 1);
      }
    }
    while (ledger_.TakeNext()) {
      Write(1);
    }
  }
  EXPECT_GT(ledger_.committed(), 2'500);  // two of four orders at a time, every 2 ms, would be 5,000
  EXPECT_LT(sent[2], 200);
}

TEST_F(RosterLate, AHostThatWasGoneForAMinuteGetsOrdersAgain) {
  Write(8);
  DueWith({1, 2}, kBeginUs);
  std::vector<order_t> due;
  for (int64_t ms = 100; ms <= 60'000; ms += 100) {
    due = DueWith({2}, kBeginUs + ms * 1000);
    EXPECT_EQ(CountOf(due, 1, 0), ms <= 350 && !due.empty() ? 4 : 0) << ms;
  }
  EXPECT_EQ(roster_.live_actors(kBeginUs + 60'000'000), 1);
  for (int64_t index = 0; index < 8; ++index) {
    Complete(index, kBeginUs + 60'100'000, 2);
  }
  Write(8);
  due = DueWith({1, 2}, kBeginUs + 60'100'000);
  EXPECT_EQ(CountOf(due, 1, 0), 4);
  EXPECT_EQ(CountOf(due, 2, 0), 4);
}

TEST_F(RosterLate, NothingIsLateBecauseTheLearnerItselfWasStopped) {
  AttentiveClock clock;
  Write(4);
  DueWith({1, 2}, clock.Look(kBeginUs));
  const int64_t woken_us = clock.Look(kBeginUs + 60'000'000);
  EXPECT_EQ(Due(woken_us).size(), 4u);  // repeated to whom they were given
  EXPECT_EQ(roster_.late_orders(), 0);
  EXPECT_EQ(roster_.live_actors(woken_us), 2);
}

}  // namespace
}  // namespace fresco
