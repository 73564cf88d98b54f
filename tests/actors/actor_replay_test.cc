// Recorded messages that somebody sends again: of the same run while it goes on, and of an earlier one.
#include <limits>

#include "msgs/protocol_times.h"
#include "tests/actors/actor_fixture.h"

namespace fresco {
namespace {

constexpr int64_t kSecondUs = 1'000'000;
constexpr int64_t kNow = 1'000'000 * kSecondUs;

class ActorReplay : public ActorTest {
 protected:
  void SetUp() override {
    wall_us_ = kNow;
    learner_.SetClock(kNow);
    BeginRun();
  }

  /// The run that the actor serves once another one is announced, at `utime` by its learner's clock.
  int64_t ServedBesideAnother(
      int64_t utime, const std::function<void(run_t&)>& change = [](run_t&) {}) {
    LearnerDouble other(*bus_, channels_, experiment_, kRunId + 1);
    other.SetClock(utime);
    other.AnnounceRun(change);
    return NextStatus().run_id;
  }

  /// As it was sent just too long before.
  void SendOld(const std::function<void()>& send) {
    learner_.SetClock(kNow - kStaleUs - 1);
    send();
    learner_.SetClock(kNow);
  }
};

TEST_F(ActorReplay, OfOrdersTakesNoOrderAwayThatWaits) {
  auto orders = Orders(100, 1);
  orders[0].current_version = 1;
  learner_.SendOrders(orders, 95);
  Step();
  SendOld([&] { learner_.SendOrders(Orders(3, 2), 2); });
  Step();
  EXPECT_EQ(NextStatus().open_orders, 1);
  EXPECT_EQ(NextStatus().oldest_open_order, 100);
}

TEST_F(ActorReplay, OfTheRunsEndDoesNotEndIt) {
  SendOld([&] { learner_.AnnounceRun([](run_t& part) { part.finished = 1; }); });
  Step();
  EXPECT_TRUE(actor_.has_run());
  learner_.AnnounceRun([](run_t& part) { part.finished = 1; });
  Step();
  EXPECT_FALSE(actor_.has_run());
}

TEST_F(ActorReplay, OfNetworksDisplacesNoneThatIsHeld) {
  const auto held = NextStatus().held_count;
  SendOld([&] {
    for (int version = 1; version < 40; ++version) {
      learner_.SendVersion({NetworkKind::kCurrent, version}, *current_);
    }
  });
  const actor_status_t status = NextStatus();
  EXPECT_EQ(status.held_count, held);
  EXPECT_GT(status.rejected_messages, 0);
  EXPECT_EQ(actor_.totals().rejected.stale, status.rejected_messages);
}

TEST_F(ActorReplay, IsToldFromALateMessage) {
  learner_.SetClock(kNow - kStaleUs);
  SendAndFly(Orders(0, 2));
  ExpectEpisodes(0, {0, 1});
  EXPECT_EQ(actor_.totals().rejected.total(), 0);
}

TEST_F(ActorReplay, IsNotHearingALearnerWhoseClockWasSetBackSoTheActorJoinsAgain) {
  learner_.SetClock(kNow - 3600 * kSecondUs);
  int seconds = 0;
  while (actor_.totals().runs < 2 && ++seconds < 20) {
    for (int i = 0; i < 20; ++i) {
      Step(kSecondUs / 20);
    }
    learner_.AnnounceRun();
  }
  EXPECT_LT(seconds, 20);
  learner_.SendVersion({NetworkKind::kCurrent, 0}, *current_);
  learner_.SendVersion({NetworkKind::kTarget, 0}, *target_);
  SendAndFly(Orders(0, 2));
  ExpectEpisodes(0, {0, 1});
}

TEST_F(ActorReplay, OfAnEarlierRunDoesNotKeepAnActorFromTheRunThatGoesOn) {
  wall_us_ = kNow + kClockToleranceUs + 1;  // what learner_ sends is of before
  LearnerDouble live(*bus_, channels_, experiment_, kRunId + 1);
  live.SetClock(wall_us_ + kClockToleranceUs);
  for (int i = 0; i < 3; ++i) {
    learner_.AnnounceRun();  // the same packets again and again
    live.AnnounceRun();
    Step();
    EXPECT_EQ(NextStatus().run_id, kRunId + 1);
  }
  EXPECT_EQ(actor_.totals().runs, 2);
}

TEST_F(ActorReplay, IsToldFromARunWhoseHostsClockIsAnother) {
  for (const int64_t later_us : {-kClockToleranceUs, kClockToleranceUs}) {
    wall_us_ = kNow + later_us;
    EXPECT_EQ(ServedBesideAnother(wall_us_), kRunId);
  }
}

TEST_F(ActorReplay, OfNoEarlierRunIsLeftForAnother) {
  wall_us_ = kNow + kClockToleranceUs + 1;
  for (const int64_t utime : {wall_us_ - kClockToleranceUs - 1, wall_us_ + kClockToleranceUs + 1,
                              std::numeric_limits<int64_t>::max(), std::numeric_limits<int64_t>::min()}) {
    EXPECT_EQ(ServedBesideAnother(utime), kRunId);
  }
}

TEST_F(ActorReplay, IsNotLeftForARunThatCantBeServed) {
  wall_us_ = kNow + kClockToleranceUs + 1;
  EXPECT_EQ(ServedBesideAnother(wall_us_, [](run_t& part) { part.config_hash ^= 1; }), kRunId);
}

}  // namespace
}  // namespace fresco
