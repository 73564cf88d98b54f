// Which run an actor serves, and for how long.
#include "actors/actor.h"

#include <algorithm>

#include "nn/mlp.h"
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

TEST_F(ActorTest, AnswersProbesAndCountsThoseOfASeries) {
  std::vector<probe_t> answers;
  MessageBus doctor(*bus_);
  doctor.Subscribe<probe_t>(channels_.echo, [&](const probe_t& answer) { answers.push_back(answer); });
  const auto ask = [&](int64_t series, int32_t number) {
    probe_t probe{};
    probe.number = number;
    probe.padding_count = 3;
    probe.padding = {1, 2, 3};
    doctor.Publish(channels_.probe, probe, {series, 0});
    Step();
    Step();
  };
  ask(7, 0);
  ask(7, 5);
  ask(8, 0);
  ask(7, 6);  // two doctors at once
  ASSERT_EQ(answers.size(), 4U);
  EXPECT_EQ(answers[3].received, 3);
  EXPECT_EQ(answers[1].run_id, 7);
  EXPECT_EQ(answers[1].number, 5);
  EXPECT_EQ(answers[1].received, 2);
  EXPECT_EQ(answers[1].actor_id, kActorId);
  EXPECT_EQ(answers[1].pid, 321);
  EXPECT_EQ(answers[1].host, "here");
  EXPECT_EQ(answers[1].padding, (std::vector<uint8_t>{1, 2, 3}));
  EXPECT_EQ(answers[2].received, 1);
}

TEST_F(ActorTest, AnswersNoAnswerAndNoEndlessFlood) {
  int answers = 0;
  MessageBus doctor(*bus_);
  doctor.Subscribe<probe_t>(channels_.echo, [&](const probe_t&) { ++answers; });
  probe_t probe{};
  probe.actor_id = 5;
  doctor.Publish(channels_.probe, probe, {7, 0});
  probe.actor_id = 0;
  doctor.Publish(channels_.probe, probe, {0, 0});
  Step();
  Step();
  EXPECT_EQ(answers, 0);
  for (int i = 0; i < 30; ++i) {
    for (int j = 0; j < 1000; ++j) {
      doctor.Publish(channels_.probe, probe, {7, 0});
    }
    Step(1);
  }
  Step(1);
  EXPECT_EQ(answers, 20'000);
}

TEST_F(ActorTest, SendsAStatusEveryStatusPeriodAndNotMoreOften) {
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
  EXPECT_EQ(actor_.totals().rejected.total(), 0);
}

TEST_F(ActorTest, HoldsOnToItsRunWhileAnotherIsAnnounced) {
  BeginRun();
  LearnerDouble other(*bus_, channels_, SmallField(), kRunId + 1);
  other.AnnounceRun();
  EXPECT_EQ(NextStatus().run_id, kRunId);
  EXPECT_EQ(actor_.totals().rejected.foreign, static_cast<int64_t>(other.RunParts().size()));
}

TEST_F(ActorTest, LeavesAFinishedRunAndServesTheNext) {
  BeginRun();
  SendAndFly(Orders(0, 2));
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
  ASSERT_EQ(next.results().size(), 1u);
  EXPECT_TRUE(
      SameBits(next.results()[0], FlyAlone(experiment, {TrainOrder(0, kEpsilon), parameters, parameters})));
  EXPECT_EQ(learner_.results().size(), 2u);
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
  for (int i = 0; i < 99; ++i) {
    Step(100'000);
  }
  EXPECT_TRUE(actor_.has_run());
  for (int i = 0; i < 3; ++i) {
    Step(100'000);
  }
  EXPECT_FALSE(actor_.has_run());
  EXPECT_FALSE(actor_.run_over());
  BeginRun();
  EXPECT_EQ(actor_.totals().runs, 2);
}

TEST_F(ActorTest, HoldsOnToItsRunWhenItsProcessWasStoppedForAMinute) {
  BeginRun();
  learner_.SendOrders(Orders(0, 2));
  now_us_ += 60'000'000;
  actor_.Step(now_us_);  // before it has polled the messages that wait
  EXPECT_TRUE(actor_.has_run());
  FlyAll();
  ExpectEpisodes(0, {0, 1});
  EXPECT_EQ(actor_.totals().runs, 1);
}

TEST_F(ActorTest, NumbersItsStatusesWithoutAGap) {
  BeginRun();
  for (int i = 0; i < 20; ++i) {
    NextStatus();
  }
  for (size_t i = 0; i < learner_.statuses().size(); ++i) {
    EXPECT_EQ(learner_.statuses()[i].sequence, static_cast<int64_t>(i));
  }
}

TEST_F(ActorTest, TellsItsStateAndWhatItsOrdersWaitFor) {
  EXPECT_NE(actor_.StateText().find("waits for a run"), std::string::npos);
  BeginRun();
  std::vector<order_t> orders = Orders(3, 7);
  orders[6].target_version = 8;
  learner_.SendVersion({NetworkKind::kTarget, 8}, *target_, {0, 1});
  learner_.SendOrders(orders);
  Step();
  const std::string text = actor_.StateText();
  for (const char* part : {"run 7700000000000001, last heard of 0.0 s ago", "5 orders flying",
                           "order 8 waits for room", "order 9 waits for target network 8 (2 chunks missing)",
                           "networks held: target 0, current 0", "2 versions completed"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  }
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
  EXPECT_EQ(actor_.totals().rejected.foreign, static_cast<int64_t>(other.RunParts().size()));
  BeginRun();
  EXPECT_EQ(NextStatus().run_id, kRunId);
}

TEST_F(ActorOfOneRunTest, PutsItsOwnCapacityAboveTheRuns) {
  BeginRun();
  EXPECT_EQ(NextStatus().capacity, 2);
  SendAndFly(Orders(0, 7));
  ExpectEpisodes(0, {0, 1, 2, 3, 4, 5, 6});
}

}  // namespace
}  // namespace fresco
