// The central promise: the same final weights, bit for bit, whatever the number of actors and
// whatever happens to the messages. Learner and actors talk over one in-process LCM bus.
#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <vector>

#include "actors/actor.h"
#include "bus/lossy_bus.h"
#include "core/clock.h"
#include "learner/learner_node.h"
#include "tests/learner/literal_run.h"

namespace fresco {
namespace {

constexpr int64_t kRunId = 77;

struct Disturbance {
  int actors = 1;
  LossOptions loss;
  bool one_vanishes = false;
  int64_t learner_dies_after = 0;  // so many episodes, and begins again with the same run_id; 0: it does not
};

class WholeRun : public ::testing::Test {
 protected:
  WholeRun()
      : experiment_(SmallExperiment()), world_(experiment_.scenario()), expected_(RunInOneLoop(experiment_)) {
    spdlog::set_level(spdlog::level::err);
  }

  struct Learner {
    Learner(WholeRun& test, Bus& bus, const Channels& channels)
        : node(test.experiment_, test.world_, kRunId, bus, channels),
          trainer(test.experiment_, test.world_, test.OutputTo(node)) {
      trainer.Begin();
    }
    LearnerNode node;
    Trainer trainer;
  };

  /// A run over a memq bus, everything stepped by this thread.
  RunResult Run(const Disturbance& disturbance) {
    const auto memory = OpenLcmBus("memq://");
    const auto bus = MakeLossyBus(*memory, disturbance.loss);
    const Channels channels = ChannelsWithPrefix("TEST");
    std::vector<std::unique_ptr<Actor>> actors;
    for (int i = 0; i < disturbance.actors; ++i) {
      ActorOptions options;
      options.actor_id = 100 + i;
      options.capacity = 3;
      actors.push_back(std::make_unique<Actor>(*bus, channels, options));
    }
    Learner first(*this, *bus, channels);
    if (disturbance.learner_dies_after == 0) {
      return Finish(first, actors, disturbance.one_vanishes);
    }
    while (first.trainer.progress().episodes < disturbance.learner_dies_after) {
      StepAll(first, actors, 0);
    }
    Learner second(*this, *bus, channels);
    return Finish(second, actors, disturbance.one_vanishes);
  }

  static void StepAll(Learner& learner, std::vector<std::unique_ptr<Actor>>& actors, size_t first_actor) {
    learner.node.Step();
    for (size_t i = first_actor; i < actors.size(); ++i) {
      actors[i]->Step(MonotonicMicroseconds());
    }
    while (const auto next = learner.node.WaitForNext(0)) {
      learner.trainer.Commit(next->order, next->episode);
    }
  }

  RunResult Finish(Learner& learner, std::vector<std::unique_ptr<Actor>>& actors, bool one_vanishes) {
    const Trainer& trainer = learner.trainer;
    const int64_t deadline_us = MonotonicMicroseconds() + 60'000'000;
    while (!trainer.finished() && MonotonicMicroseconds() < deadline_us) {
      StepAll(learner, actors, one_vanishes && trainer.progress().episodes > 20 ? 1 : 0);
    }
    EXPECT_TRUE(trainer.finished()) << learner.node.WaitingFor();
    counters_ = learner.node.counters();
    for (const auto& actor : actors) {
      resent_episodes_ += actor->totals().resent_episodes;
    }
    return {trainer.current(), trainer.progress().updates, 0, trainer.best()->evaluation.figures.average_aoi};
  }

  TrainerOutput OutputTo(LearnerNode& node) {
    TrainerOutput output;
    output.order = [&](const Order& order) { node.WriteOrder(order); };
    output.version = [&](NetworkKind kind, int32_t version, std::shared_ptr<const Vector> parameters) {
      node.OfferVersion(kind, version, std::move(parameters));
    };
    output.evaluation = [](const Evaluation&) {};
    return output;
  }

  void ExpectTheSame(const RunResult& result) {
    EXPECT_EQ(result.updates, expected_.updates);
    EXPECT_EQ(result.best_average_aoi, expected_.best_average_aoi);
    ASSERT_EQ(result.weights.size(), expected_.weights.size());
    EXPECT_TRUE(result.weights == expected_.weights);
  }

  Experiment experiment_;
  World world_;
  RunResult expected_;
  BusCounters counters_;
  int64_t resent_episodes_ = 0;
};

TEST_F(WholeRun, LearnsSomethingAndEvaluatesOnTheWay) {
  EXPECT_GT(expected_.updates, 300);
  EXPECT_GE(expected_.evaluations, 10);
  EXPECT_FALSE(expected_.weights == InitialParameters(experiment_.network_shape(), 5));
  EXPECT_TRUE(expected_.weights.allFinite());
}

TEST_F(WholeRun, FollowsFromTheSeed) {
  EXPECT_TRUE(RunInOneLoop(SmallExperiment()).weights == expected_.weights);
  EXPECT_FALSE(RunInOneLoop(SmallExperiment({{"schedule.seed", "6"}})).weights == expected_.weights);
}

TEST_F(WholeRun, GivesTheSameWeightsWithAnyNumberOfActors) {
  for (const int actors : {1, 2, 5}) {
    ExpectTheSame(Run({actors, {}, false}));
    EXPECT_EQ(counters_.rejected, 0);
  }
}

TEST_F(WholeRun, GivesTheSameWeightsThroughLossRepetitionReorderingAndCorruption) {
  LossOptions loss{0.05, 0.05, 0.1, 0, 3};
  ExpectTheSame(Run({2, loss, false}));
  EXPECT_GT(counters_.lost + counters_.duplicate, 0);
  loss.corrupt = 0.05;
  ExpectTheSame(Run({3, loss, false}));
  EXPECT_GT(counters_.rejected, 0);
}

TEST_F(WholeRun, GivesTheSameWeightsWhenAnActorVanishes) {
  ExpectTheSame(Run({3, {}, true}));
}

TEST_F(WholeRun, GivesTheSameWeightsWhenTwoHundredActorsJoinAtOnce) {
  ExpectTheSame(Run({200, {}, false}));
  EXPECT_EQ(counters_.rejected, 0);
  // What they all lack at first is sent again as one union, not two hundred times.
  const int64_t first_time = counters_.weights_chunks_sent - counters_.weights_chunks_repeated;
  EXPECT_LT(counters_.weights_chunks_repeated, 4 * first_time);
}

TEST_F(WholeRun, GivesTheSameWeightsWhenTheLearnerBeginsAgainAmongTheActorsOfBefore) {
  for (const int64_t episodes : {1, 2, 30}) {
    resent_episodes_ = 0;
    ExpectTheSame(Run({3, {}, false, episodes}));
    EXPECT_TRUE(episodes > 2 || resent_episodes_ > 0);  // what is still in the window is not flown again
    ExpectTheSame(Run({3, {0.05, 0.05, 0.1, 0.05, 5}, false, episodes}));
  }
}

TEST_F(WholeRun, GivesTheSameWeightsForPlainDqnWithoutMasksAndTheSchedulesOfThePaper) {
  experiment_ = Experiment::Parse(experiment_.Text(), "without masks",
                                  {{"agent.double_dqn", "false"},
                                   {"agent.safe_action_mask", "false"},
                                   {"agent.coverage_mask", "false"},
                                   {"schedule.linear.initial", "0.9"},
                                   {"agent.exponential.initial", "0.002"}});
  expected_ = RunInOneLoop(experiment_);
  ExpectTheSame(Run({2, {0.05, 0.02, 0.1, 0.02, 4}, false}));
}

}  // namespace
}  // namespace fresco
