// What a trainer makes of the episodes: updates, versions, the best network; against the schedule by
// hand and a literal loop over a plain list of transitions.
#include "training/trainer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "tests/training/literal_run.h"
#include "tests/worlds/test_scenarios.h"
#include "worlds/uav/flight.h"

namespace fresco {
namespace {

/// Algorithm 1 as a loop: every committed transition in one list, the newest 300 drawn from.
class LiteralTraining {
 public:
  explicit LiteralTraining(const RecordedRun& run, bool flown_return_bound = false)
      : run_(&run),
        flown_return_bound_(flown_return_bound),
        dqn_(run.experiment.network(), run.experiment.network()->InitialParameters(5),
             {true, kBatch, {0.9, 0.999, 1e-8}}) {}

  void Take(const Episode& episode) {
    const std::vector<Row> rows = RowsOf(episode);
    for (size_t i = 0; i < rows.size(); ++i) {
      const size_t last = std::min(i + n_step_, rows.size()) - 1;  // of the transitions that row i stands for
      Row row = rows[i];
      row.next_observation = rows[last].next_observation;
      row.next_mask = rows[last].next_mask;
      double reward = 0;
      for (size_t k = i; k <= last; ++k) {
        reward += std::pow(gamma_, k - i) * static_cast<double>(rows[k].reward);
      }
      row.reward = static_cast<float>(reward);
      row.discount = rows[last].discount == 0 ? 0 : static_cast<float>(std::pow(gamma_, last - i + 1));
      rows_.push_back(row);
      if (rows_.size() >= 40 && rows_.size() % 2 == 0) {
        Update();
      }
    }
  }

  const Vector& weights() const { return dqn_.current(); }

 private:
  static constexpr int kBatch = 16;
  struct Row {
    Vector observation;
    Vector next_observation;
    int16_t action = 0;
    float reward = 0;
    float discount = 1;
    std::vector<uint8_t> next_mask;
    float least_value = -std::numeric_limits<float>::infinity();
  };

  /// The transitions of an episode, one by one.
  std::vector<Row> RowsOf(const Episode& episode) const {
    std::vector<Row> rows;
    UavEnvironment environment(world_);
    environment.Reset();
    for (const int16_t action : episode.actions) {
      Row row;
      row.observation = Input(environment);
      row.action = action;
      row.reward = static_cast<float>(environment.Step(world_.ActionAt(action)).reward);
      row.next_observation = Input(environment);
      row.discount = environment.outcome() == Outcome::kFlying ? 1 : 0;
      row.next_mask.resize(static_cast<size_t>(run_->world.actions()));
      environment.WriteMask({true, true}, row.next_mask);
      if (flown_return_bound_) {
        const auto later = episode.rewards.size() - static_cast<size_t>(environment.state().slot - 2);
        row.least_value = static_cast<float>(  // the last first, so that the bits are the same
            std::accumulate(episode.rewards.rbegin(), episode.rewards.rbegin() + static_cast<int64_t>(later),
                            0.0));
      }
      rows.push_back(row);
    }
    return rows;
  }

  Vector Input(const UavEnvironment& environment) const {
    Vector input(inputs_);
    network_input_.Write(FieldsOf(environment.state()), {input.data(), static_cast<size_t>(inputs_)});
    return input;
  }

  void Update() {
    RandomStream stream(5, RandomPurpose::kReplaySampling, updates_, 0);
    MiniBatch batch(inputs_, run_->world.actions(), kBatch);
    for (int column = 0; column < kBatch; ++column) {
      size_t place = stream.NextBelow(static_cast<uint32_t>(std::min<size_t>(rows_.size(), 300)));
      while (place + 300 < rows_.size()) {
        place += 300;  // the newest transition in that place of a ring of 300
      }
      const Row& row = rows_[place];
      const auto i = static_cast<size_t>(column);
      batch.observations.col(column) = row.observation;
      batch.next_observations.col(column) = row.next_observation;
      batch.actions[i] = row.action;
      batch.rewards[i] = row.reward;
      batch.discounts[i] = row.discount;
      batch.least_values[i] = row.least_value;
      std::copy(row.next_mask.begin(), row.next_mask.end(),
                batch.next_masks.begin() + static_cast<int64_t>(i * row.next_mask.size()));
    }
    dqn_.Update(batch, 1e-2 + (1e-4 - 1e-2) * (updates_ / 390.0));  // 60 x 13 / 2 are expected
    ++updates_;
    if (updates_ % 20 == 0) {
      dqn_.CopyToTarget();
    }
  }

  const RecordedRun* run_;
  const UavWorld& world_ = RequireUavWorld(run_->world, "the test");
  const NetworkInputOptions options_{run_->experiment.agent().sensor_geometry()};
  NetworkInput network_input_{world_, options_};
  int inputs_ = NetworkInput::Size(world_.sensors(), options_);
  size_t n_step_ = static_cast<size_t>(run_->experiment.agent().n_step());
  double gamma_ = run_->experiment.agent().discount();
  bool flown_return_bound_;
  Dqn dqn_;
  std::vector<Row> rows_;
  uint32_t updates_ = 0;
};

/// Trains to the end, episode by episode beside the literal loop.
void ExpectTheWeightsOf(LiteralTraining literal, RecordedRun& run) {
  while (!run.trainer.finished()) {
    const OrderKind kind = run.next().kind;
    run.Commit(run.Fly(run.next()));
    if (kind == OrderKind::kTrain) {
      literal.Take(run.episodes.back());
    }
    ASSERT_TRUE(run.trainer.current() == literal.weights()) << "after order " << run.episodes.size() - 1;
  }
}

TEST(Trainer, TrainsOnWhatTheNetworkSeesAsTheLiteralLoopDoes) {
  for (const Settings& settings :
       {Settings{}, {{"agent.sensor_geometry", "true"}, {"schedule.excursion_share", "0.5"}}}) {
    RecordedRun run(settings);
    ExpectTheWeightsOf(LiteralTraining(run), run);
  }
}

TEST(Trainer, SumsTheRewardsOfNStepsAsTheLiteralLoopDoes) {
  for (const char* steps : {"2", "5", "100"}) {  // a power of 1/2 is exact
    RecordedRun run(Settings{{"agent.n_step", steps}, {"agent.discount", "0.5"}});
    ExpectTheWeightsOf(LiteralTraining(run), run);
  }
}

TEST(Trainer, StartsFromTheParametersThatItIsGiven) {
  const Experiment experiment = SmallExperiment();
  const auto start = std::make_shared<const Vector>(experiment.network()->InitialParameters(99));
  RecordedRun run(experiment.StartingFrom(start));
  EXPECT_TRUE(run.trainer.current() == *start);
  EXPECT_TRUE(*run.current_versions.at(0) == *start);
  EXPECT_TRUE(*run.target_versions.at(0) == *start);
}

TEST(Trainer, BoundsTargetsByWhatWasFlownAsTheLiteralLoopDoes) {
  RecordedRun run(Settings{{"agent.flown_return_bound", "true"}});
  ExpectTheWeightsOf(LiteralTraining(run, true), run);
  LiteralTraining without(run);
  for (size_t index = 0; index < run.episodes.size(); ++index) {
    if (run.orders[index].kind == OrderKind::kTrain) {
      without.Take(run.episodes[index]);
    }
  }
  EXPECT_GT((run.trainer.current() - without.weights()).cwiseAbs().maxCoeff(), 1e-2f);
}

TEST(Trainer, MakesVersionsAndTargetCopiesAtTheirUpdates) {
  FinishedRun run;
  ASSERT_EQ(run.weights.size(), 371u + 1);
  ASSERT_EQ(run.current_versions.size(), 53u + 1);
  ASSERT_EQ(run.target_versions.size(), 18u + 1);
  EXPECT_TRUE(run.weights[0] == run.experiment.network()->InitialParameters(5));
  for (size_t version = 0; version < run.current_versions.size(); ++version) {
    EXPECT_TRUE(*run.current_versions[version] == run.weights[7 * version]) << version;
  }
  for (size_t copy = 0; copy < run.target_versions.size(); ++copy) {
    EXPECT_TRUE(*run.target_versions[copy] == run.weights[20 * copy]) << copy;
  }
  for (size_t update = 1; update < run.weights.size(); ++update) {
    EXPECT_FALSE(run.weights[update] == run.weights[update - 1]) << update;
  }
}

TEST(Trainer, CountsTransitionsAndUpdatesAndLeavesEvaluationsOut) {
  FinishedRun run;
  int64_t transitions = 0;
  int64_t updates = 0;
  int64_t episodes = 0;
  for (size_t index = 0; index < run.episodes.size(); ++index) {
    if (run.orders[index].kind == OrderKind::kTrain) {
      ++episodes;
      for (int i = 0; i < run.episodes[index].transitions(); ++i) {
        ++transitions;
        updates += transitions >= 40 && transitions % 2 == 0 ? 1 : 0;
      }
    }
    const TrainerProgress& progress = run.progress[index];
    EXPECT_EQ(progress.committed_orders, static_cast<int64_t>(index) + 1);
    EXPECT_EQ(progress.episodes, episodes);
    EXPECT_EQ(progress.transitions, transitions);
    EXPECT_EQ(progress.replay_size, std::min<int64_t>(transitions, 300));
    EXPECT_EQ(progress.updates, updates);
    EXPECT_EQ(progress.current_version, updates / 7);
    EXPECT_EQ(progress.target_version, updates / 20);
  }
  EXPECT_EQ(transitions, 780);
}

TEST(Trainer, EndsWithAnEvaluationOfTheFinalWeights) {
  // 371 updates: the last version is whole for 7 updates each, and has one update for 10 each.
  for (const auto& [updates_per_version, versions] : {std::pair("7", 53), std::pair("10", 38)}) {
    RecordedRun run(Settings{{"schedule.updates_per_version", updates_per_version}});
    while (run.episodes.size() + 1 < run.orders.size() || run.trainer.progress().episodes < 60) {
      run.Commit(run.Fly(run.next()));
      EXPECT_FALSE(run.trainer.finished());
    }
    EXPECT_EQ(run.next().kind, OrderKind::kEvaluate);
    EXPECT_EQ(run.next().current_version, versions);
    EXPECT_TRUE(*run.current_versions.back() == run.trainer.current());
    EXPECT_EQ(run.current_versions.size(), static_cast<size_t>(versions) + 1);
    run.Commit(run.Fly(run.next()));
    EXPECT_TRUE(run.trainer.finished());
    EXPECT_EQ(run.trainer.last_evaluation()->version, versions);
    EXPECT_EQ(run.trainer.last_evaluation()->updates, 371);
    EXPECT_EQ(run.trainer.last_evaluation()->episodes, 60);
  }
}

TEST(TrainerDeathTest, ChecksThatTheCommittedOrderIsTheNext) {
  RecordedRun run;
  const Order first = run.orders[0];
  const Order second = run.orders[1];
  const Episode episode = run.Fly(first);
  EXPECT_DEATH(run.trainer.Commit(second, run.Fly(second)), "orders_.front");
  run.trainer.Commit(first, episode);
  EXPECT_DEATH(run.trainer.Commit(first, episode), "orders_.front");
}

}  // namespace
}  // namespace fresco
