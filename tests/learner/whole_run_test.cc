// The central promise: the same final weights, bit for bit, whatever the number of actors and
// whatever happens to the messages. Learner and actors talk over one in-process LCM bus.
#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <vector>

#include "actors/actor.h"
#include "bus/authenticated_bus.h"
#include "bus/lossy_bus.h"
#include "core/clock.h"
#include "learner/learner_node.h"
#include "msgs/message_bus.h"
#include "msgs/order.h"
#include "tests/training/literal_run.h"

namespace fresco {
namespace {

/// Somebody on the network who has no key: reads every order and answers it at once, before any actor, with
/// an episode that is possible but not the one that was ordered. Nothing in it gives it away.
class Forger {
 public:
  /// Subscribes on `bus`, which like `experiment` must outlive the forger.
  Forger(const Experiment& experiment, Bus& bus, const Channels& channels);

 private:
  void Answer(const orders_t& message);

  const Experiment* experiment_;
  Bus* bus_;
  Channels channels_;
};

Forger::Forger(const Experiment& experiment, Bus& bus, const Channels& channels)
    : experiment_(&experiment), bus_(&bus), channels_(channels) {
  bus.Subscribe(channels.orders, [this](std::span<const std::byte> bytes) {
    orders_t message{};
    if (Decode(bytes, message) || (bytes.size() > kAuthenticationTagBytes &&
                                   Decode(bytes.first(bytes.size() - kAuthenticationTagBytes), message))) {
      Answer(message);
    }
  });
}

void Forger::Answer(const orders_t& message) {
  const auto zero = std::make_shared<const Vector>(Vector::Zero(experiment_->network()->parameter_count()));
  for (const order_t& wire : message.orders) {
    Order order;
    if (FromWire(wire, order)) {
      order.epsilon = 1;
      SplitResult(experiment_->world(), FlyOrder(*experiment_, order, zero, zero), wire.actor_id,
                  [&](transitions_t& part) {
                    MessageBus(*bus_).Publish(channels_.transitions, part, IdentityOf(message));
                  });
    }
  }
}

constexpr int64_t kWholeRunId = 77;

struct Disturbance {
  int actors = 1;
  LossOptions loss = {};
  bool one_vanishes = false;
  int learner_kills = 0;  ///< the learner ends without a word and another one goes on from its checkpoint
  bool authenticated = false;
  bool forged = false;
};

/// Where an authenticated run's messages pass; a key of its own.
std::unique_ptr<Bus> Authenticated(Bus& inner) {
  const std::vector<std::byte> secret(32, std::byte{1});
  return MakeAuthenticatedBus(inner, AuthenticationKey(secret));
}

class WholeRun : public ::testing::Test {
 protected:
  WholeRun() : experiment_(SmallExperiment()), expected_(RunInOneLoop(experiment_)) {
    spdlog::set_level(spdlog::level::err);
  }

  /// A learner as far as it lives in its process's memory.
  struct Learner {
    Learner(WholeRun& test, Bus& bus)
        : node(test.experiment_, kWholeRunId, bus, ChannelsWithPrefix("TEST")),
          trainer(test.experiment_, test.OutputTo(node)) {}
    LearnerNode node;
    Trainer trainer;
  };

  /// A run over a memq bus, everything stepped by this thread.
  RunResult Run(const Disturbance& disturbance) {
    const auto memory = OpenLcmBus("memq://");
    const auto lossy = MakeLossyBus(*memory, disturbance.loss);
    const auto keyed = Authenticated(*lossy);
    Bus& bus = disturbance.authenticated ? *keyed : *lossy;
    std::optional<Forger> forger;
    if (disturbance.forged) {
      forger.emplace(experiment_, *memory, ChannelsWithPrefix("TEST"));
    }
    std::vector<std::unique_ptr<Actor>> actors;
    for (int i = 0; i < disturbance.actors; ++i) {
      ActorOptions options;
      options.actor_id = 100 + i;
      options.capacity = 3;
      actors.push_back(std::make_unique<Actor>(bus, ChannelsWithPrefix("TEST"), options));
    }
    // Killed learners stay subscribed to the bus that all share, but nobody listens to them any more.
    std::vector<std::unique_ptr<Learner>> learners;
    learners.push_back(std::make_unique<Learner>(*this, bus));
    learners.back()->trainer.Begin();
    TrainingState checkpoint = learners.back()->trainer.Save();
    const int64_t deadline_us = MonotonicMicroseconds() + 60'000'000;
    while (!learners.back()->trainer.finished() && MonotonicMicroseconds() < deadline_us) {
      Learner& learner = *learners.back();
      learner.node.Step();
      const size_t stepping = disturbance.one_vanishes && learner.trainer.progress().episodes > 20 ? 1 : 0;
      for (size_t i = stepping; i < actors.size(); ++i) {
        actors[i]->Step(MonotonicMicroseconds());
      }
      while (auto next = learner.node.WaitForNext(0)) {
        learner.trainer.Commit(next->order, std::move(next->episode));
        if (learner.trainer.progress().committed_orders % kOrdersPerCheckpoint == 0) {
          checkpoint = learner.trainer.Save();
        }
      }
      const auto kills = static_cast<int>(learners.size()) - 1;
      if (kills < disturbance.learner_kills && learner.trainer.progress().episodes > 15 * (kills + 1)) {
        learners.push_back(std::make_unique<Learner>(*this, bus));
        learners.back()->trainer.Resume(checkpoint);
      }
    }
    const Learner& learner = *learners.back();
    EXPECT_TRUE(learner.trainer.finished()) << learner.node.WaitingFor();
    counters_ = learner.node.counters();
    return {learner.trainer.current(), learner.trainer.progress().updates, 0,
            learner.trainer.best()->evaluation.score(),
            learner.trainer.delivered() ? std::optional(learner.trainer.delivered()->score()) : std::nullopt};
  }

  TrainerOutput OutputTo(LearnerNode& node) {
    TrainerOutput output;
    output.order = [&](const Order& order) { node.WriteOrder(order); };
    output.version = [&](NetworkVersion version, std::shared_ptr<const Vector> parameters) {
      node.OfferVersion(version, std::move(parameters));
    };
    output.evaluation = [](const Evaluation&) {};
    return output;
  }

  static constexpr int64_t kOrdersPerCheckpoint = 11;

  void ExpectTheSame(const RunResult& result) {
    EXPECT_EQ(result.updates, expected_.updates);
    EXPECT_EQ(result.best_score, expected_.best_score);
    EXPECT_EQ(result.delivered_score, expected_.delivered_score);
    ASSERT_EQ(result.weights.size(), expected_.weights.size());
    EXPECT_TRUE(result.weights == expected_.weights);
  }

  Experiment experiment_;
  RunResult expected_;
  BusCounters counters_;
  int64_t resent_episodes_ = 0;
};

TEST_F(WholeRun, LearnsSomethingAndEvaluatesOnTheWay) {
  EXPECT_GT(expected_.updates, 300);
  EXPECT_GE(expected_.evaluations, 10);
  EXPECT_FALSE(expected_.weights == experiment_.network()->InitialParameters(5));
  EXPECT_TRUE(expected_.weights.allFinite());
}

TEST_F(WholeRun, FollowsFromTheSeed) {
  EXPECT_TRUE(RunInOneLoop(SmallExperiment()).weights == expected_.weights);
  EXPECT_FALSE(RunInOneLoop(SmallExperiment({{"schedule.seed", "6"}})).weights == expected_.weights);
}

TEST_F(WholeRun, GivesTheSameWeightsWithAnyNumberOfActors) {
  for (const int actors : {1, 2, 5}) {
    ExpectTheSame(Run({.actors = actors}));
    EXPECT_EQ(counters_.rejected, 0);
  }
}

TEST_F(WholeRun, GivesTheSameWeightsThroughLossRepetitionReorderingAndCorruption) {
  LossOptions loss{0.05, 0.05, 0.1, 0, 3};
  ExpectTheSame(Run({.actors = 2, .loss = loss}));
  EXPECT_GT(counters_.lost + counters_.duplicate, 0);
  loss.corrupt = 0.05;
  ExpectTheSame(Run({.actors = 3, .loss = loss}));
  EXPECT_GT(counters_.rejected, 0);
}

TEST_F(WholeRun, GivesTheSameWeightsAmongForgersWhereMessagesAreAuthenticated) {
  const RunResult forged = Run({.actors = 2, .forged = true});
  EXPECT_EQ(counters_.rejected, 0);  // nobody noticed
  EXPECT_FALSE(forged.weights == expected_.weights);
  ExpectTheSame(Run({.actors = 2, .authenticated = true, .forged = true}));
  EXPECT_GT(counters_.rejected_unauthenticated, 60);  // an episode each at least
  EXPECT_EQ(counters_.rejected, counters_.rejected_unauthenticated);
}

TEST_F(WholeRun, GivesTheSameWeightsWhereAuthenticatedMessagesAreLostRepeatedReorderedAndCorrupted) {
  ExpectTheSame(
      Run({.actors = 2, .loss = {0.05, 0.05, 0.1, 0.05, 3}, .authenticated = true, .forged = true}));
  EXPECT_GT(counters_.rejected_unauthenticated, 60);
}

TEST_F(WholeRun, SaysThatItWaitsAmongProgramsWithAnotherKey) {
  const auto memory = OpenLcmBus("memq://");
  const auto keyed = Authenticated(*memory);
  const Channels channels = ChannelsWithPrefix("TEST");
  LearnerNode node(experiment_, kWholeRunId, *keyed, channels);
  node.WriteOrder({});
  EXPECT_FALSE(node.WaitForNext(0).has_value());
  EXPECT_EQ(node.WaitingFor(), "an actor to join");
  memory->Publish(channels.actor_status, std::vector<std::byte>(100));
  while (keyed->Poll(0) > 0) {
  }
  EXPECT_EQ(
      node.WaitingFor(),
      "an actor to join (1 messages dropped: made with another key than that of --key-file here, or with "
      "none)");
  EXPECT_EQ(node.counters().rejected_unauthenticated, 1);
}

TEST_F(WholeRun, GivesTheSameWeightsWhenAnActorVanishes) {
  ExpectTheSame(Run({.actors = 3, .one_vanishes = true}));
}

TEST_F(WholeRun, GivesTheSameWeightsWhenTheLearnerIsKilledAndResumed) {
  ExpectTheSame(Run({.actors = 2, .learner_kills = 3}));
  ExpectTheSame(
      Run({.actors = 3, .loss = {0.05, 0.05, 0.1, 0.02, 6}, .one_vanishes = true, .learner_kills = 3}));
}

TEST_F(WholeRun, GivesTheSameWeightsWhenTwoHundredActorsJoinAtOnce) {
  ExpectTheSame(Run({.actors = 200}));
  EXPECT_EQ(counters_.rejected, 0);
  // What they all lack at first is sent again as one union, not two hundred times.
  const int64_t first_time = counters_.weights_chunks_sent - counters_.weights_chunks_repeated;
  EXPECT_LT(counters_.weights_chunks_repeated, 4 * first_time);
}

TEST_F(WholeRun, GivesTheSameWeightsInCartPole) {
  experiment_ = SmallCartPole();
  expected_ = RunInOneLoop(experiment_);
  ASSERT_TRUE(expected_.delivered_score.has_value());
  for (const int actors : {1, 4}) {
    ExpectTheSame(Run({.actors = actors}));
    EXPECT_EQ(counters_.rejected, 0);
  }
  ExpectTheSame(Run({.actors = 2, .learner_kills = 3}));
  ExpectTheSame(
      Run({.actors = 3, .loss = {0.05, 0.05, 0.1, 0.02, 6}, .one_vanishes = true, .learner_kills = 3}));
}

TEST_F(WholeRun, GivesTheSameWeightsForPlainDqnWithoutMasksAndTheSchedulesOfThePaper) {
  experiment_ = Experiment::Parse(experiment_.Text(), "without masks",
                                  {{"agent.double_dqn", "false"},
                                   {"agent.safe_action_mask", "false"},
                                   {"agent.coverage_mask", "false"},
                                   {"schedule.linear.initial", "0.9"},
                                   {"agent.exponential.initial", "0.002"}});
  expected_ = RunInOneLoop(experiment_);
  ExpectTheSame(Run({.actors = 2, .loss = {0.05, 0.02, 0.1, 0.02, 4}}));
}

}  // namespace
}  // namespace fresco
