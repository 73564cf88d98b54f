// Which run an actor serves, and for how long.
#include "actors/actor.h"

#include <algorithm>

#include "tests/actors/actor_fixture.h"

namespace fresco {
namespace {

TEST_F(ActorTest, AsksForARunWhileThereIsNone) {
  for (int i = 0; i < 2; ++i) {
    const actor_status_t status = NextStatus();
    EXPECT_EQ(status.run_id, 0);
    EXPECT_EQ(status.config_hash, 0);
    EXPECT_EQ(status.actor_id, kActorId);
    EXPECT_EQ(status.pid, 321);
    EXPECT_EQ(status.host, "here");
    EXPECT_EQ(status.arithmetic_fingerprint, ArithmeticFingerprint());
    EXPECT_EQ(status.capacity, 0);
    EXPECT_EQ(status.open_orders, 0);
    EXPECT_EQ(status.held_count, 0);
    EXPECT_EQ(status.missing_count, 0);
  }
}

TEST_F(ActorTest, SendsAStatusEveryStatusPeriodAndNotMoreOften) {
  Step(5'000'000);  // so far ahead of the real clock that only steps count
  const size_t before = learner_.statuses().size();
  for (int i = 0; i < 1000; ++i) {
    Step(1000);
  }
  EXPECT_NEAR(static_cast<double>(learner_.statuses().size() - before), 10, 1);
}

TEST_F(ActorTest, ServesARunOnceEveryPartOfItsConfigurationIsHere) {
  auto parts = learner_.RunParts();
  ASSERT_GE(parts.size(), 2u);
  std::reverse(parts.begin(), parts.end());
  for (const run_t& part : parts) {
    Step();
    EXPECT_FALSE(actor_.has_run());
    learner_.Send(channels_.run, part);
  }
  const actor_status_t status = NextStatus();
  EXPECT_TRUE(actor_.has_run());
  EXPECT_EQ(IdentityOf(status), learner_.identity());
  EXPECT_EQ(status.capacity, 5);
  learner_.AnnounceRun();  // as every half second
  Step();
  EXPECT_EQ(actor_.totals().runs, 1);
  EXPECT_EQ(actor_.totals().rejected_messages, 0);
}

TEST_F(ActorTest, HoldsOnToItsRunWhileAnotherIsAnnounced) {
  BeginRun();
  LearnerDouble other(*bus_, channels_, SmallField(), kRunId + 1);
  other.AnnounceRun();
  EXPECT_EQ(NextStatus().run_id, kRunId);
  EXPECT_EQ(actor_.totals().rejected_messages, static_cast<int64_t>(other.RunParts().size()));
}

TEST_F(ActorTest, LeavesAFinishedRunAndServesTheNext) {
  BeginRun();
  learner_.SendOrders(Orders(0, 2));
  FlyAll();
  learner_.AnnounceRun([](run_t& part) { part.finished = 1; });
  Step();
  EXPECT_FALSE(actor_.has_run());
  EXPECT_TRUE(actor_.run_over());
  EXPECT_EQ(NextStatus().run_id, 0);

  const Experiment experiment = SmallField(WithMasks());  // of other sizes
  LearnerDouble next(*bus_, channels_, experiment, kRunId + 1);
  next.AnnounceRun();
  Step();
  EXPECT_TRUE(actor_.has_run());
  EXPECT_FALSE(actor_.run_over());
  const SharedParameters parameters = SampleNetwork(experiment, 5);
  next.SendVersion({NetworkKind::kCurrent, 0}, *parameters);
  next.SendVersion({NetworkKind::kTarget, 0}, *parameters);
  next.SendOrders(Orders(0, 1));
  FlyAll();
  ASSERT_EQ(next.episodes().size(), 1u);
  EXPECT_TRUE(SameBits(next.episodes()[0], FlyAlone(World(experiment.scenario()), experiment,
                                                    {TrainOrder(0, kEpsilon), parameters, parameters})));
  EXPECT_EQ(learner_.episodes().size(), 2u);
  EXPECT_EQ(actor_.totals().runs, 2);
}

TEST_F(ActorTest, DoesNotBeginAFinishedRun) {
  learner_.AnnounceRun([](run_t& part) { part.finished = 1; });
  Step();
  EXPECT_FALSE(actor_.has_run());
  EXPECT_EQ(actor_.totals().runs, 0);
}

TEST_F(ActorTest, LeavesARunThatHasFallenSilentAndServesItWhenItIsBack) {
  BeginRun();
  Step(5'000'000);
  EXPECT_TRUE(actor_.has_run());
  Step(6'000'000);
  EXPECT_FALSE(actor_.has_run());
  EXPECT_FALSE(actor_.run_over());
  now_us_ = 0;  // the actor's clock caught up with the real one's
  BeginRun();
  EXPECT_EQ(actor_.totals().runs, 2);
}

class ActorOfOneRunTest : public ActorTest {
 protected:
  ActorOfOneRunTest() : ActorTest(Options()) {}
  static ActorOptions Options() {
    ActorOptions options = OptionsOfTheActor();
    options.run_id = kRunId;
    options.capacity = 2;
    return options;
  }
};

TEST_F(ActorOfOneRunTest, ServesNoOtherRun) {
  LearnerDouble other(*bus_, channels_, experiment_, kRunId + 1);
  other.AnnounceRun();
  Step();
  EXPECT_FALSE(actor_.has_run());
  EXPECT_EQ(actor_.totals().rejected_messages, static_cast<int64_t>(other.RunParts().size()));
  BeginRun();
  EXPECT_EQ(NextStatus().run_id, kRunId);
}

TEST_F(ActorOfOneRunTest, PutsItsOwnCapacityAboveTheRuns) {
  BeginRun();
  EXPECT_EQ(NextStatus().capacity, 2);
  learner_.SendOrders(Orders(0, 7));
  FlyAll();
  ExpectEpisodes(0, {0, 1, 2, 3, 4, 5, 6});
}

}  // namespace
}  // namespace fresco
