// What is foretold of the learner's memory, against what its parts really take of the heap.
#include "learner/learner_process.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <memory>
#include <string>

#include "learner/weight_publisher.h"
#include "msgs/versions_in_flight.h"
#include "nn/mlp.h"
#include "nn/set_network.h"
#include "storage/checkpoint_file.h"
#include "tests/support/heap_use.h"
#include "tests/training/literal_run.h"
#include "tests/worlds/play.h"
#include "training/dqn.h"
#include "training/ledger.h"
#include "training/replay_memory.h"

namespace fresco {
namespace {

constexpr double kMemoryTolerance = 0.02;

/// The episode in vectors that have grown transition by transition.
Episode Grown(const Episode& episode) {
  Episode grown;
  const auto grow = [](const auto& from, auto& to) {
    for (const auto& value : from) {
      to.push_back(value);
    }
  };
  grown.ending = episode.ending;
  grow(episode.states, grown.states);
  grow(episode.actions, grown.actions);
  grow(episode.rewards, grown.rewards);
  grow(episode.next_masks, grown.next_masks);
  return grown;
}

/// `foretold` within `tolerance` of what was measured.
void ExpectNear(int64_t measured, int64_t foretold, double tolerance = kMemoryTolerance) {
  EXPECT_NEAR(static_cast<double>(measured), static_cast<double>(foretold),
              tolerance * static_cast<double>(measured));
}

using LearnerMemoryTest = HeapUseTest;

TEST_F(LearnerMemoryTest, OfTheReplayMemoryAndItsActionsIsForetold) {
  ExpectNear(HeapUseOf([] { return std::make_unique<ReplayMemory>(25, 45, 10'000); }),
             ReplayMemory::BytesFor(25, 45, 10'000));
}

/// Of episodes as the ledger hands them out, whose vectors have grown part by part.
TEST_F(LearnerMemoryTest, OfTheEpisodesInTheReplayMemoryIsForetold) {
  constexpr int64_t kTransitions = 20'000;
  for (const char* steps : {"100", "500"}) {
    const Experiment experiment = SmallCartPole({{"cartpole.maximum_steps", steps},
                                                 {"agent.replay_capacity", std::to_string(kTransitions)},
                                                 {"schedule.minimum_replay_size", "1000000"},
                                                 {"schedule.episodes", "100000"},
                                                 {"schedule.window", "1"}});
    const Episode episode = Play(experiment.world(), 1, [](std::span<const float> state) {
      return state[2] + state[3] > 0 ? 1 : 0;  // as long as can be
    });
    ASSERT_EQ(episode.transitions(), experiment.world().longest_episode());
    std::deque<Order> orders;
    Trainer trainer(experiment, {[&](const Order& order) { orders.push_back(order); },
                                 [](NetworkVersion, std::shared_ptr<const Vector>) {},
                                 [](const Evaluation&) {},
                                 {}});
    trainer.Begin();
    const auto commit_up_to = [&](int64_t transitions) {
      while (trainer.progress().transitions < transitions) {
        const Order order = orders.front();
        orders.pop_front();
        trainer.Commit(order, Grown(episode));
      }
      return std::make_unique<int>(0);
    };
    const int64_t measured = HeapUseOf([&] { return commit_up_to(kTransitions); });
    ExpectNear(measured, EpisodeHistory::BytesFor(experiment.world(), kTransitions), 0.1);
    EXPECT_LT(HeapUseOf([&] { return commit_up_to(4 * kTransitions); }), measured / 20) << "it was full";
  }
}

TEST_F(LearnerMemoryTest, OfABatchAndOfTheNetworksIsForetold) {
  constexpr int kColumns = 500;
  constexpr int kThreads = 2;
  ExpectNear(HeapUseOf([&] { return std::make_unique<MiniBatch>(25, 45, kColumns); }),
             MiniBatch::BytesFor(25, 45, kColumns));
  MiniBatch batch(25, 45, kColumns);
  for (Matrix* matrix : {&batch.observations, &batch.next_observations}) {
    matrix->setZero();
  }
  std::fill(batch.next_masks.begin(), batch.next_masks.end(), uint8_t{1});
  const std::shared_ptr<const Network> networks[] = {
      std::make_shared<Mlp>(MlpShape({25, 300, 200, 45})),
      std::make_shared<SetNetwork>(SetShape{1, 4, 6, 9, {64, 64}, {128, 128}, {64}})};
  for (const std::shared_ptr<const Network>& network : networks) {
    const Vector initial = network->InitialParameters(1);
    const int64_t measured = HeapUseOf([&] {
      auto dqn =
          std::make_unique<Dqn>(network, initial, DqnOptions{.batch_size = kColumns, .adam = {}}, kThreads);
      dqn->Update(batch, 1e-3);
      return dqn;
    });
    ExpectNear(measured, Dqn::ParameterBytes(*network) + Dqn::BatchBytes(*network, kColumns, kThreads));
  }
}

TEST_F(LearnerMemoryTest, OfOrdersInFlightIsForetoldAtMost) {
  const RecordedRun run;
  constexpr int64_t kManyOrders = 300;
  OrderResult result = ResultOf(run.next(), run.Fly(run.next()));
  const int64_t measured = HeapUseOf([&] {
    auto ledger = std::make_unique<Ledger>(run.world);
    for (int64_t index = 0; index < kManyOrders; ++index) {
      Order order;
      order.index = index;
      order.seed = result.seed;
      ledger->Write(order);
      result.order_index = index;
      for (int first = 1; first < result.episode.transitions(); ++first) {  // all but the first one
        EXPECT_EQ(ledger->Add(PartOf(run.world, result, first, 1)), Ledger::Arrival::kAccepted);
      }
    }
    for (result.order_index = 0; result.order_index < kManyOrders; ++result.order_index) {
      EXPECT_EQ(ledger->Add(PartOf(run.world, result, 0, 1)), Ledger::Arrival::kCompleted);
    }
    return ledger;
  });
  const int64_t foretold = Ledger::BytesFor(run.world, kManyOrders);
  EXPECT_LE(measured, foretold);
  EXPECT_GE(measured, foretold / 2);  // a vector that grows has between once and twice the room that it needs
}

TEST_F(LearnerMemoryTest, OfAPublishedVersionIsForetold) {
  constexpr int kVersions = 20;
  const auto parameters = std::make_shared<const Vector>(Vector::Zero(200'000));
  const int64_t measured = HeapUseOf([&] {
    auto publisher = std::make_unique<WeightPublisher>();
    for (int version = 0; version < kVersions; ++version) {
      publisher->Offer({NetworkKind::kCurrent, version}, parameters);
    }
    return publisher;
  });
  ExpectNear(measured, kVersions * WeightPublisher::BytesPerVersion(parameters->size()), 0.05);
}

/// Returns the most versions that a run's orders hold back at a time; they are no more than foretold.
VersionsInFlight ExpectVersionsForetoldAtMost(RecordedRun& run) {
  VersionsInFlight most;
  while (!run.trainer.finished()) {
    run.Commit(run.Fly(run.next()));
    VersionsInFlight now;
    for (const VersionState& version : run.trainer.Save().versions) {
      ++(version.version.kind == NetworkKind::kCurrent ? now.current : now.target);
    }
    most = {std::max(most.current, now.current), std::max(most.target, now.target)};
  }
  const VersionsInFlight foretold = MostVersionsInFlight(run.experiment);
  EXPECT_LE(most.current, foretold.current);
  EXPECT_LE(most.target, foretold.target);
  return most;
}

/// Where every episode is as long as it can be, they are hardly fewer.
void ExpectVersionsForetold(const Settings& settings) {
  RecordedRun run(settings);
  const VersionsInFlight most = ExpectVersionsForetoldAtMost(run);
  const VersionsInFlight foretold = MostVersionsInFlight(run.experiment);
  // Less where evaluations, which make no updates, take places of the window.
  EXPECT_GE(most.current + 3, foretold.current * 9 / 10);
  EXPECT_GE(most.target + 3, foretold.target * 9 / 10);
}

TEST_F(LearnerMemoryTest, OfVersionsThatOrdersHoldBackIsForetold) {
  ExpectVersionsForetold({});
  ExpectVersionsForetold({{"schedule.updates_per_version", "1"}, {"agent.target_update_period", "1"}});
  ExpectVersionsForetold({{"schedule.window", "20"}, {"schedule.updates_per_version", "2"}});
}

TEST_F(LearnerMemoryTest, OfVersionsThatManyEvaluationsHoldBackIsForetoldAtMost) {
  RecordedRun run(SmallCartPole({{"schedule.updates_per_version", "1"},
                                 {"schedule.versions_per_evaluation", "1"},
                                 {"agent.target_update_period", "1"}}));
  ExpectVersionsForetoldAtMost(run);
}

TEST_F(LearnerMemoryTest, OfACheckpointIsForetoldAtMost) {
  RecordedRun run(Settings{{"agent.hidden_layers", "200,200"}});
  while (run.trainer.progress().updates < 100) {
    run.Commit(run.Fly(run.next()));
  }
  const TrainingState state = run.trainer.Save();
  const int64_t foretold = CheckpointBytes(state.current.size(), static_cast<int64_t>(state.versions.size()),
                                           EpisodeHistory::BytesFor(run.world, 300));
  const auto file =
      static_cast<int64_t>(SerializeCheckpoint({run.experiment, ArithmeticFingerprint(), 1, state}).size());
  const int64_t copied = HeapUseOf([&] { return std::make_unique<TrainingState>(run.trainer.Save()); });
  EXPECT_LE(copied + 3 * file, foretold * 11 / 10);  // message, content and file are of one size
  EXPECT_GE(copied + 3 * file, foretold * 9 / 10);
}

TEST_F(LearnerMemoryTest, OfAConfigurationGrowsWithEveryFieldThatSetsIt) {
  const int64_t usual = LearnerMemory(SmallExperiment()).bytes();
  for (const auto& [field, value] : Settings{{"agent.replay_capacity", "100000000"},
                                             {"agent.batch_size", "65536"},
                                             {"agent.hidden_layers", "2000,2000"},
                                             {"schedule.window", "4096"},
                                             {"schedule.updates_per_version", "1"},
                                             {"run.optimum_memory_mb", "100000"}}) {
    EXPECT_GT(LearnerMemory(SmallExperiment({{field, value}})).bytes(), usual) << field;
  }
  EXPECT_LT(LearnerMemory(SmallExperiment({{"run.optimum_limit_s", "0"}})).bytes(), usual - 2'000'000'000);
}

// The largest of everything that a configuration may say, without an overflow on the way.
TEST_F(LearnerMemoryTest, OfTheLargestConfigurationIsPositive) {
  const Experiment largest = SmallExperiment({{"agent.replay_capacity", "100000000"},
                                              {"agent.hidden_layers", "3000,3000"},
                                              {"agent.batch_size", "4096"},
                                              {"scenario.slots", "10000"},
                                              {"scenario.initial_energy_j", "1e9"},
                                              {"schedule.window", "4096"},
                                              {"schedule.inserts_per_update", "1"},
                                              {"schedule.updates_per_version", "1"},
                                              {"agent.target_update_period", "1"},
                                              {"schedule.episodes", "4000000000"},
                                              {"run.optimum_memory_mb", "1000000"}});
  const MemoryNeed need = LearnerMemory(largest);
  for (const MemoryPart& part : need.parts) {
    EXPECT_GE(part.bytes, 0) << part.purpose;
  }
  EXPECT_GT(need.bytes(), int64_t{1'000'000'000'000'000});
}

}  // namespace
}  // namespace fresco
