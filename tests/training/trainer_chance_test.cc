// A trainer in CartPole, where chance decides and episodes are cut off: what it learns from, how it judges
// the versions, and what it delivers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/training/literal_run.h"
#include "tests/worlds/play.h"
#include "training/schedules.h"

namespace fresco {
namespace {

constexpr uint64_t kCartPoleSeed = 5;
constexpr int kEpisodesPerEvaluation = 3;

/// Algorithm 1 as a loop over a list of all transitions, with a ring of the newest 150.
class LiteralCartPoleTraining {
 public:
  /// `bootstraps`: whether a transition after which the episode was cut off has a value in its next state.
  LiteralCartPoleTraining(const Experiment& experiment, bool bootstraps)
      : world_(&experiment.world()),
        bootstraps_(bootstraps),
        dqn_(experiment.network(), experiment.network()->InitialParameters(kCartPoleSeed),
             {true, kBatch, {0.9, 0.999, 1e-8}}) {}

  void Take(const Episode& episode) {
    for (size_t i = 0; i < episode.actions.size(); ++i) {
      const std::span<const float> next = episode.state(i + 1);
      const bool failed =
          std::abs(next[0]) > 2.4f || std::abs(static_cast<double>(next[2])) > 12 * std::numbers::pi / 180;
      Row row{Vector(4), Vector(4), episode.actions[i], failed};
      world_->Observe(episode.state(i), {row.observation.data(), 4});
      world_->Observe(next, {row.next_observation.data(), 4});
      if (!bootstraps_ && i + 1 == episode.actions.size()) {
        row.terminal = true;
      }
      rows_.push_back(row);
      if (rows_.size() >= 40 && rows_.size() % 2 == 0) {
        Update();
      }
    }
  }

  const Vector& weights() const { return dqn_.current(); }

 private:
  static constexpr int kBatch = 16;
  static constexpr size_t kCapacity = 150;
  struct Row {
    Vector observation;
    Vector next_observation;
    int16_t action = 0;
    bool terminal = false;
  };

  void Update() {
    RandomStream stream(kCartPoleSeed, RandomPurpose::kReplaySampling, updates_, 0);
    MiniBatch batch(4, 2, kBatch);
    for (int column = 0; column < kBatch; ++column) {
      size_t place = stream.NextBelow(static_cast<uint32_t>(std::min(rows_.size(), kCapacity)));
      while (place + kCapacity < rows_.size()) {
        place += kCapacity;
      }
      const Row& row = rows_[place];
      const auto i = static_cast<size_t>(column);
      batch.observations.col(column) = row.observation;
      batch.next_observations.col(column) = row.next_observation;
      batch.actions[i] = row.action;
      batch.rewards[i] = 1;
      batch.discounts[i] = row.terminal ? 0.0f : 0.99f;
      batch.least_values[i] = -std::numeric_limits<float>::infinity();
      batch.next_masks[2 * i] = batch.next_masks[2 * i + 1] = 1;
    }
    dqn_.Update(batch, 1e-2 + (1e-4 - 1e-2) * std::min(1.0, updates_ / 300.0));  // 50 x 12 / 2 are expected
    if (++updates_ % 20 == 0) {
      dqn_.CopyToTarget();
    }
  }

  const World* world_;
  bool bootstraps_;
  Dqn dqn_;
  std::vector<Row> rows_;
  uint32_t updates_ = 0;
};

TEST(TrainerInCartPole, LearnsFromEpisodesThatWereCutOffAsTheLiteralLoopDoes) {
  RecordedRun run(SmallCartPole());
  LiteralCartPoleTraining literal(run.experiment, true);
  LiteralCartPoleTraining without(run.experiment, false);
  int cut_off = 0;
  while (!run.trainer.finished()) {
    const OrderKind kind = run.next().kind;
    run.Commit(run.Fly(run.next()));
    if (kind == OrderKind::kTrain) {
      cut_off += run.episodes.back().ending == Ending::kTruncated ? 1 : 0;
      literal.Take(run.episodes.back());
      without.Take(run.episodes.back());
    }
    ASSERT_TRUE(run.trainer.current() == literal.weights()) << "after order " << run.episodes.size() - 1;
  }
  EXPECT_GT(cut_off, 5);
  EXPECT_LT(cut_off, 50);
  EXPECT_FALSE(run.trainer.current() == without.weights());
}

/// The positions of evaluations among the orders of a run.
std::vector<size_t> EvaluationsIn(const RecordedRun& run) {
  std::vector<size_t> positions;
  for (size_t index = 0; index < run.orders.size(); ++index) {
    if (run.orders[index].kind == OrderKind::kEvaluate) {
      positions.push_back(index);
    }
  }
  return positions;
}

/// Mean return and share of cut off episodes, of the three from this position among the evaluations on.
void ExpectMeans(const RecordedRun& run, size_t first, const Evaluation& evaluation) {
  const std::vector<size_t> positions = EvaluationsIn(run);
  double earned = 0;
  int cut_off = 0;
  for (size_t i = first; i < first + kEpisodesPerEvaluation; ++i) {
    const Episode& episode = run.episodes[positions.at(i)];
    EXPECT_EQ(run.orders[positions[i]].current_version, evaluation.version);
    earned += episode.transitions();
    cut_off += episode.transitions() == 12 && episode.ending == Ending::kTruncated ? 1 : 0;
  }
  ASSERT_EQ(evaluation.figures.size(), 1u);
  EXPECT_NEAR(evaluation.score(), earned / kEpisodesPerEvaluation, 1e-12);
  ASSERT_EQ(evaluation.scores.size(), size_t{kEpisodesPerEvaluation});
  for (size_t i = 0; i < evaluation.scores.size(); ++i) {
    EXPECT_EQ(evaluation.scores[i], run.episodes[positions[first + i]].transitions());
  }
  EXPECT_NEAR(evaluation.success, cut_off / 3.0, 1e-12);
}

TEST(TrainerInCartPole, JudgesEveryVersionByTheMeansOfFreshEpisodes) {
  FinishedRun run(SmallCartPole());
  const std::vector<size_t> positions = EvaluationsIn(run);
  ASSERT_GT(run.evaluations.size(), 5u);
  ASSERT_EQ(positions.size(), kEpisodesPerEvaluation * (run.evaluations.size() + 1));  // and the delivery
  for (size_t i = 0; i < run.evaluations.size(); ++i) {
    ExpectMeans(run, kEpisodesPerEvaluation * i, run.evaluations[i]);
  }
  for (size_t i = 0; i < positions.size(); ++i) {
    const Order& order = run.orders[positions[i]];
    EXPECT_EQ(order.seed, EvaluationSeed(kCartPoleSeed, static_cast<int64_t>(i))) << i;
    EXPECT_EQ(order.epsilon, 0);
    if (i % kEpisodesPerEvaluation != 0) {
      EXPECT_EQ(positions[i], positions[i - 1] + 1) << "the episodes of an evaluation follow each other";
    }
  }
}

TEST(TrainerInCartPole, DeliversTheBestVersionWithTheScoreOfEpisodesThatDidNotChooseIt) {
  RecordedRun run(SmallCartPole());
  while (!run.trainer.progress().delivering) {
    EXPECT_FALSE(run.trainer.finished());
    run.Commit(run.Fly(run.next()));
  }
  EXPECT_EQ(run.trainer.progress().episodes, 50);
  const BestNetwork best = run.trainer.best().value();
  const size_t evaluations = run.evaluations.size();
  ASSERT_EQ(run.orders.size(), run.episodes.size() + kEpisodesPerEvaluation);
  EXPECT_TRUE(*run.current_versions.back() == *best.parameters);
  EXPECT_TRUE(*best.parameters == *run.current_versions.at(static_cast<size_t>(best.evaluation.version)));
  EXPECT_FALSE(run.trainer.delivered());
  run.Finish();
  ASSERT_TRUE(run.trainer.delivered());
  ExpectMeans(run, kEpisodesPerEvaluation * evaluations, *run.trainer.delivered());
  EXPECT_EQ(run.trainer.delivered()->updates, best.evaluation.updates);
  EXPECT_EQ(run.trainer.delivered()->episodes, 50);
  // Nothing else has changed.
  EXPECT_EQ(run.evaluations.size(), evaluations);
  EXPECT_EQ(run.trainer.best()->evaluation.version, best.evaluation.version);
  EXPECT_EQ(run.trainer.best()->evaluation.score(), best.evaluation.score());
  EXPECT_TRUE(run.trainer.last_evaluation()->updates == run.trainer.progress().updates);
}

TEST(TrainerInCartPole, HasNoMoreOrdersInFlightThanIsForetold) {
  for (const char* window : {"1", "6"}) {
    RecordedRun run(SmallCartPole({{"schedule.updates_per_version", "1"},
                                   {"schedule.versions_per_evaluation", "1"},
                                   {"schedule.window", window}}));
    const auto most = static_cast<size_t>(MaximumOrdersInFlight(run.experiment.schedule()));
    size_t in_flight = 0;
    while (!run.trainer.finished()) {
      run.Commit(run.Fly(run.next()));
      in_flight = std::max(in_flight, run.orders.size() - run.episodes.size());
      EXPECT_NO_THROW(Trainer(run.experiment, {[](const Order&) {},
                                               [](NetworkVersion, std::shared_ptr<const Vector>) {},
                                               [](const Evaluation&) {},
                                               {}})
                          .Resume(run.trainer.Save()));
    }
    EXPECT_LE(in_flight, most);
    EXPECT_GE(in_flight, most - kEpisodesPerEvaluation);
  }
}

TEST(TrainerOverTheField, DeliversNothingSinceItsEvaluationsAreExact) {
  const FinishedRun run;
  EXPECT_FALSE(run.trainer.delivered());
  EXPECT_FALSE(run.trainer.progress().delivering);
}

/// Every update makes a version, and every version wants an evaluation. Its episodes are chosen here.
class TrainerBestOfChance : public ::testing::Test {
 protected:
  TrainerBestOfChance()
      : run_(SmallCartPole({{"schedule.updates_per_version", "1"},
                            {"schedule.versions_per_evaluation", "1"},
                            {"schedule.minimum_replay_size", "1"},
                            {"schedule.window", "3"}})) {
    const Rule to_the_right = [](std::span<const float>) { return 1; };
    const Rule balance = [](std::span<const float> state) { return state[2] + state[3] > 0 ? 1 : 0; };
    for (uint64_t seed = 0; shorter_.actions.empty() || longer_.actions.empty(); ++seed) {
      const Episode fallen = Play(run_.world, seed, to_the_right);
      (fallen.transitions() < 10 ? shorter_ : longer_) = fallen;
    }
    cut_off_ = Play(run_.world, 0, balance);
  }

  /// Trains to the next evaluation, which has these episodes; returns the version that was evaluated.
  int64_t Evaluate(const std::vector<Episode>& episodes) {
    while (run_.next().kind == OrderKind::kTrain) {
      run_.Commit(run_.Fly(run_.next()));
    }
    const int64_t version = run_.next().current_version;
    const size_t before = run_.evaluations.size();
    for (const Episode& episode : episodes) {
      EXPECT_EQ(run_.evaluations.size(), before) << "not before its last episode";
      EXPECT_EQ(run_.next().current_version, version);
      run_.Commit(episode);
    }
    EXPECT_EQ(run_.evaluations.size(), before + 1);
    EXPECT_EQ(run_.evaluations.back().version, version);
    return version;
  }

  void ExpectBest(int64_t version) {
    const BestNetwork& best = run_.trainer.best().value();
    EXPECT_EQ(best.evaluation.version, version);
    EXPECT_TRUE(*best.parameters == run_.weights[static_cast<size_t>(version)]);
  }

  RecordedRun run_;
  Episode shorter_;
  Episode longer_;
  Episode cut_off_;
};

TEST_F(TrainerBestOfChance, HasEpisodesToChooseFrom) {
  EXPECT_EQ(shorter_.ending, Ending::kTerminal);
  EXPECT_EQ(longer_.ending, Ending::kTerminal);
  EXPECT_LT(shorter_.transitions(), longer_.transitions());
  EXPECT_LT(longer_.transitions(), cut_off_.transitions());
  EXPECT_EQ(cut_off_.ending, Ending::kTruncated);
}

TEST_F(TrainerBestOfChance, IsTheLastOneUntilAnEpisodeSucceeds) {
  ExpectBest(Evaluate({longer_, longer_, longer_}));
  ExpectBest(Evaluate({shorter_, shorter_, shorter_}));
  EXPECT_EQ(run_.evaluations.back().success, 0);
  ExpectBest(Evaluate({shorter_, cut_off_, shorter_}));
  EXPECT_NEAR(run_.evaluations.back().success, 1 / 3.0, 1e-12);
}

TEST_F(TrainerBestOfChance, SucceededMostOften) {
  Evaluate({longer_, longer_, cut_off_});
  const int64_t twice = Evaluate({cut_off_, shorter_, cut_off_});
  ExpectBest(twice);
  Evaluate({longer_, longer_, cut_off_});
  ExpectBest(twice);
  ExpectBest(Evaluate({cut_off_, cut_off_, cut_off_}));
}

TEST_F(TrainerBestOfChance, HasTheLargestScoreOfEqualSuccessAndIsTheEarliestOfEquals) {
  Evaluate({shorter_, longer_, cut_off_});
  const int64_t largest = Evaluate({longer_, longer_, cut_off_});
  ExpectBest(largest);
  EXPECT_NE(Evaluate({longer_, cut_off_, longer_}), largest);
  Evaluate({cut_off_, shorter_, shorter_});
  ExpectBest(largest);
}

TEST(TrainerInCartPole, FliesTheSameEpisodesInEveryEvaluationIfTheyAreFixed) {
  const FinishedRun fresh(SmallCartPole());
  const FinishedRun run(SmallCartPole({{"schedule.fixed_evaluation_episodes", "true"}}));
  EXPECT_TRUE(run.trainer.current() == fresh.trainer.current());  // evaluations have no influence
  const std::vector<size_t> positions = EvaluationsIn(run);
  ASSERT_GT(positions.size(), 5u * kEpisodesPerEvaluation);
  const std::vector<uint64_t> seeds = FixedEvaluationSeeds(run.experiment.schedule());
  const std::vector<uint64_t> delivery = FixedDeliverySeeds(run.experiment.schedule());
  for (size_t i = 0; i < positions.size(); ++i) {
    const bool delivered = i + kEpisodesPerEvaluation >= positions.size();
    EXPECT_EQ(run.orders[positions[i]].seed, (delivered ? delivery : seeds)[i % kEpisodesPerEvaluation]);
  }
  for (const Evaluation& evaluation : run.evaluations) {
    EXPECT_EQ(evaluation.scores.size(), seeds.size());
  }
}

TEST(FixedEvaluationSeeds, AreThreeAndNoneOfThemJudgesTheDelivery) {
  const Experiment experiment = SmallCartPole();
  std::vector<uint64_t> seeds = FixedEvaluationSeeds(experiment.schedule());
  const std::vector<uint64_t> delivery = FixedDeliverySeeds(experiment.schedule());
  seeds.insert(seeds.end(), delivery.begin(), delivery.end());
  ASSERT_EQ(seeds.size(), 6u);
  for (size_t i = 0; i < seeds.size(); ++i) {
    EXPECT_EQ(seeds[i], EvaluationSeed(kCartPoleSeed, static_cast<int64_t>(i)));
  }
}

}  // namespace
}  // namespace fresco
