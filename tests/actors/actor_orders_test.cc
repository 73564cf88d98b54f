// What an actor flies and sends, and what it forgets.
#include <limits>

#include "tests/actors/actor_fixture.h"

namespace fresco {
namespace {

class ActorOrders : public ActorTest {
 protected:
  /// Four orders of a version that is not here.
  void SendWaitingOrders(int64_t first, int64_t committed) {
    std::vector<order_t> orders = Orders(first, 4);
    for (order_t& order : orders) {
      order.current_version = 1;
    }
    learner_.SendOrders(orders, committed);
    Step();
  }
};

TEST_F(ActorOrders, GiveWholeEpisodesWithTheBitsOfAFlyer) {
  BeginRun();
  SendAndFly(Orders(0, 5));
  ExpectEpisodes(0, {0, 1, 2, 3, 4});
  EXPECT_GT(learner_.results()[0].episode.transitions(), LayoutOf(experiment_.world()).transitions);
  EXPECT_EQ(learner_.senders(), std::set<int64_t>{kActorId});
  int64_t transitions = 0;
  for (const OrderResult& result : learner_.results()) {
    transitions += result.episode.transitions();
  }
  const actor_status_t status = NextStatus();
  EXPECT_EQ(status.episodes, 5);
  EXPECT_EQ(status.transitions, transitions);
  EXPECT_EQ(status.resent_episodes, 0);
  EXPECT_EQ(status.rejected_messages, 0);
  EXPECT_EQ(status.open_orders, 0);
}

TEST_F(ActorOrders, ThatSearchInARunWithoutSearchesAreCountedAndIgnored) {
  BeginRun();
  std::vector<order_t> orders = Orders(0, 2);
  orders[0].search_width = 5;
  SendAndFly(orders);
  ExpectEpisodes(0, {1});
  EXPECT_EQ(actor_.totals().rejected.total(), 1);
}

TEST_F(ActorOrders, WaitForRoom) {
  BeginRun();
  learner_.SendOrders(Orders(0, 12));
  Step();
  EXPECT_EQ(NextStatus().open_orders, 12);
  FlyAll();
  EXPECT_EQ(NextStatus().open_orders, 0);
  ExpectEpisodes(0, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11});
}

TEST_F(ActorOrders, AreFlownOnceHoweverOftenTheyAreRepeated) {
  BeginRun();
  for (int i = 0; i < 200; ++i) {
    learner_.SendOrders(Orders(0, 3));
    Step(10);
  }
  ExpectEpisodes(0, {0, 1, 2});
  EXPECT_EQ(NextStatus().resent_episodes, 0);
}

TEST_F(ActorOrders, OfOtherActorsAreIgnored) {
  BeginRun();
  SendAndFly({OrderTo(kActorId + 1, 0), OrderTo(kActorId, 1), OrderTo(0, 2)});
  ExpectEpisodes(0, {1});
  EXPECT_EQ(actor_.totals().rejected.total(), 0);
}

TEST_F(ActorOrders, OfAnotherRunOrConfigurationAreCountedAndIgnored) {
  BeginRun();
  orders_t message{};
  message.order_count = 1;
  message.orders = Orders(0, 1);
  learner_.Send(channels_.orders, message, {kRunId + 1, learner_.identity().config_hash});
  learner_.Send(channels_.orders, message, {kRunId, learner_.identity().config_hash ^ 1});
  FlyAll();
  EXPECT_EQ(NextStatus().rejected_messages, 2);
  EXPECT_EQ(NextStatus().episodes, 0);
}

TEST_F(ActorOrders, OfNoRunAreIgnored) {
  SendAndFly(Orders(0, 1));
  BeginRun();
  FlyAll();
  EXPECT_TRUE(learner_.results().empty());
}

TEST_F(ActorOrders, ThatAreAnnouncedAgainHaveWhatWasFlownSentAgainEveryFiftyMilliseconds) {
  BeginRun();
  SendAndFly(Orders(0, 2));
  Step(50'000);
  for (int i = 0; i < 10; ++i) {  // with the attempt it had: a resumed learner counts anew
    learner_.SendOrders({OrderTo(kActorId, 0)});
    Step(10'000);
  }
  ExpectEpisodes(0, {0, 0, 0, 1});
  EXPECT_EQ(NextStatus().resent_episodes, 2);
  EXPECT_EQ(NextStatus().episodes, 2);
}

TEST_F(ActorOrders, ThatAreAnnouncedAgainInFlightAreAnsweredByThatFlight) {
  BeginRun();
  learner_.SendOrders(Orders(0, 1));
  Step();
  SendAndFly({OrderTo(kActorId, 0, 1)});
  SendAndFly({OrderTo(kActorId, 0, 1)});  // the result is on its way
  ExpectEpisodes(0, {0});
}

TEST_F(ActorOrders, OfAResumedLearnerAreAnsweredWithWhatIsStillHereAndFlownAgainOtherwise) {
  BeginRun();
  SendAndFly(Orders(0, 5));
  learner_.SendOrders({}, 3);
  Step(50'000);
  SendAndFly(Orders(0, 5), 0);  // its checkpoint was at 0
  ExpectEpisodes(5, {0, 1, 2, 3, 4});
  EXPECT_EQ(NextStatus().resent_episodes, 2);
  EXPECT_EQ(NextStatus().episodes, 8);
}

TEST_F(ActorOrders, ThatAreNotTheOnesFlownUnderTheirIndexAreFlown) {
  BeginRun();
  order_t other = OrderTo(kActorId, 0);
  other.epsilon = 1;
  SendAndFly({other});
  SendAndFly(Orders(0, 1));
  ExpectEpisodes(1, {0});
}

TEST_F(ActorOrders, OutsideOfTheWindowAreRefused) {
  BeginRun();  // the window is 16: with as many evaluations, 32 orders
  learner_.SendOrders({OrderTo(kActorId, 31), OrderTo(kActorId, 32), OrderTo(kActorId, 4000)});
  learner_.SendOrders({OrderTo(kActorId, 1)}, -1);
  SendAndFly({OrderTo(kActorId, 1)}, std::numeric_limits<int64_t>::max());
  ExpectEpisodes(0, {31});
  EXPECT_EQ(actor_.totals().rejected.total(), 4);
}

TEST_F(ActorOrders, ThatWaitedAreForgottenWhereTheWindowHasGoneBack) {
  BeginRun();
  SendWaitingOrders(40, 40);
  actor_status_t status = NextStatus();
  EXPECT_EQ(status.open_orders, 4);
  EXPECT_EQ(status.oldest_open_order, 40);
  learner_.SendOrders({}, 0);
  Step();
  status = NextStatus();
  EXPECT_EQ(status.open_orders, 0);
  EXPECT_EQ(status.oldest_open_order, -1);
  EXPECT_EQ(status.missing_count, 0);
}

TEST_F(ActorOrders, OfWhichTheOldestIsOpenAreReported) {
  BeginRun();
  learner_.SendOrders(Orders(2, 9), 0);  // five fly, four wait
  Step();
  EXPECT_EQ(NextStatus().oldest_open_order, 2);
  learner_.SendOrders({}, 5);  // others were quicker
  EXPECT_EQ(NextStatus().oldest_open_order, 5);
}

TEST_F(ActorOrders, ThatAreCommittedAreNotFlown) {
  BeginRun();
  SendAndFly(Orders(0, 4), 2);
  ExpectEpisodes(0, {2, 3});
  EXPECT_EQ(actor_.totals().rejected.total(), 0);
}

TEST_F(ActorOrders, ThatWaitedAreForgottenOnceCommitted) {
  BeginRun();
  SendWaitingOrders(0, 0);
  EXPECT_EQ(NextStatus().open_orders, 4);
  learner_.SendOrders({}, 3);  // another actor has flown them
  EXPECT_EQ(NextStatus().open_orders, 1);
  learner_.SendVersion({NetworkKind::kCurrent, 1}, *current_);
  FlyAll();
  ExpectEpisodes(0, {3});
}

}  // namespace
}  // namespace fresco
