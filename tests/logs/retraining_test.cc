// Compares training from logs with the run that was recorded, which a simple loop flew and trained.
#include "logs/retraining.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.h"
#include "tests/logs/run_log.h"
#include "tests/support/temporary_folder.h"

namespace fresco {
namespace {

using Use = Retraining::Use;
using testing::HasSubstr;
using testing::ThrowsMessage;

bool IsTransitions(const OwnedEvent& event) {
  return event.channel == "FRESCO_TRANSITIONS";
}

class RetrainingTest : public testing::Test {
 protected:
  /// Trains from a log of these events to the end.
  std::unique_ptr<Retraining> Retrain(const std::vector<OwnedEvent>& events, const Experiment& experiment,
                                      Use use = Use::kSameRun, bool strict = false) {
    const auto path = folder_.path() / "log";
    WriteLog(path, events);
    episodes_ = std::make_unique<LoggedEpisodes>(LogSource{{path}}, Identity(live_), live_.world);
    auto retraining = std::make_unique<Retraining>(
        experiment, *episodes_, use, strict,
        [this](const Trainer&, const Evaluation& evaluation) { evaluations_.push_back(evaluation); });
    while (retraining->Step()) {
    }
    EXPECT_TRUE(retraining->trainer().finished());
    return retraining;
  }

  void ExpectTheLiveRun(const Retraining& retraining) const {
    EXPECT_EQ(retraining.trainer().current(), live_.trainer.current());
    EXPECT_EQ(evaluations_.size(), live_.evaluations.size());
    EXPECT_EQ(retraining.counts().compared_versions,
              live_.current_versions.size() + live_.target_versions.size());
    EXPECT_EQ(retraining.counts().different_versions, 0);
  }

  int64_t orders() const { return static_cast<int64_t>(live_.orders.size()); }

  const TemporaryFolder folder_;
  const FinishedRun live_;
  std::unique_ptr<LoggedEpisodes> episodes_;
  std::vector<Evaluation> evaluations_;
};

TEST_F(RetrainingTest, GivesTheWeightsOfTheLiveRunFromAWholeLog) {
  const auto retraining = Retrain(EventsOf(live_, Identity(live_)), live_.experiment, Use::kSameRun, true);
  ExpectTheLiveRun(*retraining);
  EXPECT_EQ(retraining->counts().recorded_episodes, orders());
  EXPECT_EQ(retraining->counts().flown_again, 0);
  EXPECT_TRUE(episodes_->Missing().empty());
}

TEST_F(RetrainingTest, FliesAgainWhatTheLogMisses) {
  std::vector<OwnedEvent> events = EventsOf(live_, Identity(live_));
  int64_t removed = 0;
  int count = 0;
  std::erase_if(events, [&](const OwnedEvent& event) {
    const bool erase = IsTransitions(event) && ++count % 10 == 0;
    removed += erase ? 1 : 0;
    return erase;
  });
  ASSERT_GT(removed, 5);
  const auto retraining = Retrain(events, live_.experiment);
  ExpectTheLiveRun(*retraining);
  // Each of these episodes fits one message.
  EXPECT_EQ(retraining->counts().flown_again, removed);
  EXPECT_EQ(retraining->counts().recorded_episodes, orders() - removed);
}

TEST_F(RetrainingTest, TakesEventsInAnyOrderTwiceAndWithOthersAmongThem) {
  const std::vector<OwnedEvent> once = EventsOf(live_, Identity(live_));
  const std::vector<OwnedEvent> foreign = EventsOf(live_, Identity(live_, 78));
  std::vector<OwnedEvent> events = once;
  events.insert(events.end(), once.begin(), once.end());
  events.insert(events.end(), foreign.begin(), foreign.end());
  events.push_back({0, "CAMERA", std::vector<std::byte>(200, std::byte{1})});
  std::reverse(events.begin(), events.end());
  for (size_t i = 0; i < events.size(); ++i) {
    events[i].utime = static_cast<int64_t>(i);
  }
  const auto retraining = Retrain(events, live_.experiment);
  ExpectTheLiveRun(*retraining);
  EXPECT_EQ(retraining->counts().flown_again, 0);
}

TEST_F(RetrainingTest, TrainsAloneFromALogWithoutTransitions) {
  std::vector<OwnedEvent> events = EventsOf(live_, Identity(live_));
  std::erase_if(events, IsTransitions);
  const auto retraining = Retrain(events, live_.experiment);
  ExpectTheLiveRun(*retraining);
  EXPECT_EQ(retraining->counts().flown_again, orders());
}

TEST_F(RetrainingTest, DoesNotTakeWhatDoesNotFollowFromItsActions) {
  std::vector<OwnedEvent> events = EventsOf(live_, Identity(live_));
  const auto forged = std::find_if(events.begin(), events.end(), IsTransitions);
  transitions_t message{};
  ASSERT_TRUE(Decode(forged->message, message));
  message.reward[0] += 1;
  Encode(message, forged->message);
  const auto retraining = Retrain(events, live_.experiment);
  ExpectTheLiveRun(*retraining);
  EXPECT_EQ(retraining->counts().flown_again, 1);
}

TEST_F(RetrainingTest, SaysThatTheLogIsOfOtherNetworks) {
  const RecordedRun other(Settings{{"schedule.seed", "6"}});
  std::vector<OwnedEvent> events = EventsOf(live_, Identity(live_));
  const std::vector<OwnedEvent> others = EventsOf(other, Identity(live_));
  events.insert(events.end(), others.begin(), others.end());  // its version 0
  const auto retraining = Retrain(events, live_.experiment);
  EXPECT_EQ(retraining->trainer().current(), live_.trainer.current());
  EXPECT_GT(retraining->counts().different_versions, 0);
  EXPECT_EQ(retraining->counts().first_different_version, 0);
}

TEST_F(RetrainingTest, RefusesAMissWhereItIsToldToBeStrict) {
  std::vector<OwnedEvent> events = EventsOf(live_, Identity(live_));
  const auto last = std::find_if(events.rbegin(), events.rend(), IsTransitions);
  events.erase(std::next(last).base());
  EXPECT_THAT([&] { Retrain(events, live_.experiment, Use::kSameRun, true); },
              ThrowsMessage<Error>(HasSubstr("order " + std::to_string(orders() - 1))));
}

TEST_F(RetrainingTest, TrainsAnotherAgentOnTheRecordedExperience) {
  const Experiment other = SmallExperiment({{"agent.hidden_layers", "8"}, {"agent.double_dqn", "false"}});
  const auto retraining = Retrain(EventsOf(live_, Identity(live_)), other, Use::kExperience);
  EXPECT_EQ(retraining->counts().recorded_episodes, 60);
  EXPECT_EQ(retraining->counts().evaluations_flown, evaluations_.size());
  EXPECT_EQ(retraining->counts().compared_versions, 0);
  EXPECT_NE(retraining->trainer().current().size(), live_.trainer.current().size());
}

/// The other agent differs only in an option that does not influence training, so it must learn the same.
TEST_F(RetrainingTest, GivesExperienceToTrainingOrdersInTheirOrder) {
  const Experiment same = SmallExperiment({{"schedule.ladder.exponent", "6.5"}});
  ASSERT_NE(same.hash(), live_.experiment.hash());
  const auto retraining = Retrain(EventsOf(live_, Identity(live_)), same, Use::kExperience);
  EXPECT_EQ(retraining->trainer().current(), live_.trainer.current());
}

TEST_F(RetrainingTest, LeavesOutExperienceThatItsMasksForbid) {
  FinishedRun unmasked(Settings{{"agent.coverage_mask", "false"}});
  const auto path = folder_.path() / "log";
  WriteLog(path, EventsOf(unmasked, Identity(unmasked)));
  LoggedEpisodes episodes({{path}}, Identity(unmasked), unmasked.world);
  const Experiment masked = SmallExperiment({{"schedule.episodes", "3"}});
  Retraining retraining(masked, episodes, Use::kExperience, false, [](const Trainer&, const Evaluation&) {});
  const auto train = [&] {
    while (retraining.Step()) {
    }
  };
  // Random schedules of sensors out of reach are in nearly every episode.
  EXPECT_THAT(train, ThrowsMessage<Error>(HasSubstr("has run out")));
  EXPECT_GT(retraining.counts().left_out, 30);
}

/// Trains in CartPole from the log of `run`.
class CartPoleRetraining {
 public:
  CartPoleRetraining(const FinishedRun& run, const std::vector<OwnedEvent>& events,
                     const Experiment& experiment, Use use)
      : episodes_(Written(folder_, events), Identity(run), run.world),
        retraining_(experiment, episodes_, use, false, [](const Trainer&, const Evaluation&) {}) {
    while (retraining_.Step()) {
    }
  }
  const Retraining& result() const { return retraining_; }

 private:
  static LogSource Written(const TemporaryFolder& folder, const std::vector<OwnedEvent>& events) {
    WriteLog(folder.path() / "log", events);
    return {{folder.path() / "log"}};
  }

  const TemporaryFolder folder_;
  LoggedEpisodes episodes_;
  Retraining retraining_;
};

void ExpectTheWeightsOf(const FinishedRun& live, const Retraining& retraining) {
  EXPECT_TRUE(retraining.trainer().current() == live.trainer.current());
  EXPECT_EQ(retraining.counts().different_versions, 0);
  ASSERT_TRUE(retraining.trainer().delivered());
  EXPECT_EQ(retraining.trainer().delivered()->figures, live.trainer.delivered()->figures);
}

TEST(CartPoleRetrainingTest, GivesTheWeightsOfTheLiveRun) {
  const FinishedRun live(SmallCartPole());
  const CartPoleRetraining retraining(live, EventsOf(live, Identity(live)), live.experiment, Use::kSameRun);
  ExpectTheWeightsOf(live, retraining.result());
  EXPECT_EQ(retraining.result().counts().flown_again, 0);
  EXPECT_EQ(retraining.result().counts().recorded_episodes, live.orders.size());
}

TEST(CartPoleRetrainingTest, FliesAgainWhatTheLogMisses) {
  const FinishedRun live(SmallCartPole());
  std::vector<OwnedEvent> events = EventsOf(live, Identity(live));
  std::erase_if(events, [count = 0](const OwnedEvent& event) mutable {
    return IsTransitions(event) && ++count % 3 == 0;
  });
  const CartPoleRetraining retraining(live, events, live.experiment, Use::kSameRun);
  ExpectTheWeightsOf(live, retraining.result());
  EXPECT_EQ(retraining.result().counts().flown_again, live.orders.size() / 3);
}

/// Each recorded episode begins where its own seed says, which is not the one of the order that it is used
/// for.
TEST(CartPoleRetrainingTest, TrainsAnotherAgentOnTheRecordedExperience) {
  const FinishedRun live(SmallCartPole());
  const Experiment other = SmallCartPole({{"schedule.seed", "6"}, {"agent.hidden_layers", "9"}});
  const CartPoleRetraining retraining(live, EventsOf(live, Identity(live)), other, Use::kExperience);
  const Retraining::Counts& counts = retraining.result().counts();
  EXPECT_EQ(counts.recorded_episodes, 50);
  EXPECT_EQ(counts.left_out, 0);
  EXPECT_GT(counts.evaluations_flown, 0);
  int64_t transitions = 0;
  for (size_t i = 0; i < live.orders.size(); ++i) {
    transitions += live.orders[i].kind == OrderKind::kTrain ? live.episodes[i].transitions() : 0;
  }
  EXPECT_EQ(retraining.result().trainer().progress().transitions, transitions);
}

TEST_F(RetrainingTest, RefusesExperienceThatIsTooShort) {
  const Experiment longer = SmallExperiment({{"schedule.episodes", "61"}});
  EXPECT_THAT([&] { Retrain(EventsOf(live_, Identity(live_)), longer, Use::kExperience); },
              ThrowsMessage<Error>(HasSubstr("--set schedule.episodes=60")));
}

}  // namespace
}  // namespace fresco
