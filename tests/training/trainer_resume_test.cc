// A training that is saved and gone on with, by another trainer and through a checkpoint's bytes, against
// the one that was not disturbed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <set>
#include <utility>

#include "core/error.h"
#include "storage/checkpoint_file.h"
#include "tests/support/error_of.h"
#include "tests/training/literal_run.h"

namespace fresco {
namespace {

using testing::HasSubstr;

/// The bytes of a file with the state.
std::string OnDisk(const Experiment& experiment, const TrainingState& state) {
  return SerializeCheckpoint({experiment, 1, 77, state});
}

/// Through the bytes of a file, as a learner that was killed sees it.
TrainingState FromDisk(const Experiment& experiment, const TrainingState& state) {
  return ParseCheckpoint(OnDisk(experiment, state), "a test").training;
}

/// A trainer that goes on from a state, with everything that it hands out.
struct Resumed {
  Resumed(const RecordedRun& run, const TrainingState& state)
      : trainer(run.experiment, {[this](const Order& order) { orders.push_back(order); },
                                 [this](NetworkVersion version, std::shared_ptr<const Vector> parameters) {
                                   versions[version] = std::move(parameters);
                                 },
                                 [this](const Evaluation&) { ++evaluations; },
                                 {}}) {
    trainer.Resume(state);
    orders_at_resume = orders.size();
  }

  std::vector<Order> orders;
  std::map<NetworkVersion, std::shared_ptr<const Vector>> versions;
  int evaluations = 0;
  size_t orders_at_resume = 0;
  Trainer trainer;
};

/// Saves after every `stride`-th commit and finishes each time from there.
void ExpectTheSameFromEverywhere(const Experiment& experiment, size_t stride) {
  FinishedRun whole(experiment);
  RecordedRun run(experiment);
  const std::string last = OnDisk(experiment, whole.trainer.Save());
  for (size_t committed = 0; committed < whole.episodes.size(); ++committed) {
    if (committed % stride == 0) {
      Resumed resumed(run, FromDisk(run.experiment, run.trainer.Save()));
      ASSERT_EQ(resumed.orders_at_resume, run.orders.size() - committed);
      ASSERT_TRUE(OnDisk(experiment, resumed.trainer.Save()) == OnDisk(experiment, run.trainer.Save()))
          << "after " << committed;
      for (size_t next = committed; next < whole.episodes.size(); ++next) {
        ASSERT_EQ(resumed.orders.at(next - committed), whole.orders.at(next)) << "from " << committed;
        resumed.trainer.Commit(whole.orders[next], whole.episodes[next]);
      }
      ASSERT_TRUE(resumed.trainer.finished());
      ASSERT_TRUE(resumed.trainer.current() == whole.trainer.current()) << "from " << committed;
      ASSERT_EQ(resumed.trainer.progress().updates, whole.trainer.progress().updates);
      ASSERT_EQ(resumed.trainer.progress().loss, whole.trainer.progress().loss);
      ASSERT_EQ(resumed.trainer.best()->evaluation.version, whole.trainer.best()->evaluation.version);
      ASSERT_TRUE(*resumed.trainer.best()->parameters == *whole.trainer.best()->parameters);
      ASSERT_TRUE(OnDisk(experiment, resumed.trainer.Save()) == last) << "from " << committed;
    }
    run.Commit(whole.episodes[committed]);
  }
}

TEST(TrainerResume, GivesTheSameWeightsFromEveryEpisodeOn) {
  ExpectTheSameFromEverywhere(SmallExperiment(), 1);
}

TEST(TrainerResume, GivesTheSameWeightsWithNStepTargetsOfEpisodesThatWereSearched) {
  ExpectTheSameFromEverywhere(SmallExperiment({{"agent.n_step", "4"},
                                               {"agent.discount", "0.9"},
                                               {"schedule.search.share", "0.5"},
                                               {"schedule.search.width", "4"}}),
                              5);
}

TEST(TrainerResume, GivesTheSameWeightsWithBoundsFromWholeEpisodesAndPlainDqn) {
  ExpectTheSameFromEverywhere(SmallExperiment({{"agent.flown_return_bound", "true"},
                                               {"agent.double_dqn", "false"},
                                               {"agent.sensor_geometry", "true"},
                                               {"agent.exponential.initial", "0.002"},
                                               {"schedule.linear.initial", "0.9"}}),
                              7);
}

TEST(TrainerResume, GivesTheSameWeightsWhereTheReplayMemoryIsSmallerThanAnEpisode) {
  const Settings settings = {
      {"agent.replay_capacity", "10"}, {"agent.batch_size", "8"}, {"schedule.minimum_replay_size", "4"}};
  ExpectTheSameFromEverywhere(SmallExperiment(settings), 5);
  ExpectTheSameFromEverywhere(SmallCartPole(settings), 5);
}

/// Evaluations of three episodes, and three more of the best version in the end.
TEST(TrainerResume, GivesTheSameWeightsInTheMidstOfAnEvaluationAndOfTheDelivery) {
  const Experiment experiment = SmallCartPole();
  RecordedRun run(experiment);
  std::set<std::pair<bool, int>> seen;  // whether it delivers, and how many episodes are in so far
  while (!run.trainer.finished()) {
    run.Commit(run.Fly(run.next()));
    const TrainingState state = run.trainer.Save();
    seen.emplace(state.progress.delivering, state.partial_evaluation.episodes);
  }
  const std::set<std::pair<bool, int>> expected = {{false, 0}, {false, 1}, {false, 2},
                                                   {true, 0},  {true, 1},  {true, 2}};
  ASSERT_EQ(seen, expected);
  ExpectTheSameFromEverywhere(experiment, 1);
}

/// Resumes where `run` stands.
void ExpectTheVersionsThatOrdersInFlightName(const RecordedRun& run) {
  const Resumed resumed(run, FromDisk(run.experiment, run.trainer.Save()));
  EXPECT_FALSE(resumed.orders.empty());
  for (const Order& order : resumed.orders) {
    const auto current = static_cast<size_t>(order.current_version);
    const auto target = static_cast<size_t>(order.target_version);
    EXPECT_TRUE(*resumed.versions.at({NetworkKind::kCurrent, order.current_version}) ==
                *run.current_versions.at(current));
    EXPECT_TRUE(*resumed.versions.at({NetworkKind::kTarget, order.target_version}) ==
                *run.target_versions.at(target));
  }
  EXPECT_LT(resumed.versions.size(), run.current_versions.size())
      << "versions that nobody names are forgotten";
}

TEST(TrainerResume, HandsOutTheVersionsThatOrdersInFlightName) {
  RecordedRun run;
  for (int i = 0; i < 30; ++i) {
    run.Commit(run.Fly(run.next()));
  }
  ExpectTheVersionsThatOrdersInFlightName(run);
}

TEST(TrainerResume, HandsOutTheVersionThatIsDelivered) {
  RecordedRun run(SmallCartPole());
  while (!run.trainer.progress().delivering) {
    run.Commit(run.Fly(run.next()));
  }
  ASSERT_FALSE(*run.current_versions.back() == run.trainer.current()) << "the best is not the last one";
  ExpectTheVersionsThatOrdersInFlightName(run);
}

/// The episode with its last transition once more.
Episode Longer(Episode episode) {
  const auto append = [&](auto& values) {
    const auto size = static_cast<int64_t>(values.size() / episode.rewards.size());
    const std::vector last(values.end() - size, values.end());
    values.insert(values.end(), last.begin(), last.end());
  };
  append(episode.states);
  append(episode.actions);
  append(episode.next_masks);
  append(episode.rewards);
  return episode;
}

class TrainerResumeRefusal : public ::testing::Test {
 protected:
  TrainerResumeRefusal() {
    for (int i = 0; i < 40; ++i) {
      run_.Commit(run_.Fly(run_.next()));
    }
    state_ = run_.trainer.Save();
  }

  std::string Refusal() const {
    return ErrorOf([&] { Resumed(run_, state_); }, ErrorKind::kFailure);
  }

  RecordedRun run_;
  TrainingState state_;
};

TEST_F(TrainerResumeRefusal, RefusesNothingOfAStateAsItWasSaved) {
  EXPECT_NO_THROW(Resumed(run_, state_));
}

TEST_F(TrainerResumeRefusal, NamesAVersionThatIsMissing) {
  state_.versions.erase(state_.versions.begin());
  EXPECT_THAT(Refusal(), HasSubstr("lacks a network version"));
}

TEST_F(TrainerResumeRefusal, NamesAGapInTheOrders) {
  state_.orders.erase(state_.orders.begin() + 1);
  EXPECT_THAT(Refusal(), HasSubstr("expected order 41, found 42"));
}

TEST_F(TrainerResumeRefusal, NamesEpisodesThatDoNotFitTheWorld) {
  const std::vector<std::function<void(Episode&)>> lies = {
      [](Episode& episode) { episode.ending = Ending::kNone; },
      [](Episode& episode) { episode.states.pop_back(); },
      [](Episode& episode) { episode.rewards.push_back(0); },
      [](Episode& episode) { episode.next_masks.pop_back(); },
      [](Episode& episode) { episode.actions.back() = 15; },  // 5 moves with 2 sensors: 0 to 14
      [](Episode& episode) { episode.actions.front() = -1; },
      [](Episode& episode) {
        episode.Clear();
        episode.states.resize(6);
        episode.ending = Ending::kTerminal;
      },
      [](Episode& episode) { episode = Longer(episode); },
  };
  for (const auto& lie : lies) {
    for (const size_t position : {size_t{0}, state_.replay.size() - 1}) {
      const TrainingState saved = state_;
      Episode episode = *state_.replay[position];
      lie(episode);
      state_.replay[position] = std::make_shared<const Episode>(std::move(episode));
      EXPECT_THAT(Refusal(), HasSubstr("not one of this world")) << &lie - lies.data();
      state_ = saved;
    }
  }
}

TEST_F(TrainerResumeRefusal, NamesAnotherNumberOfTransitionsThanTheReplayMemoryHas) {
  // 24 of the 13 transitions each: 300 in the memory, and the first twelve of the oldest before them.
  ASSERT_EQ(state_.replay.size(), 24u);
  state_.replay.erase(state_.replay.begin());
  EXPECT_THAT(Refusal(), HasSubstr("expected 300 transitions"));
  EXPECT_THAT(Refusal(), HasSubstr("found 299"));
  state_.replay.assign(100, state_.replay.front());
  EXPECT_THAT(Refusal(), HasSubstr("found 1300"));
}

TEST_F(TrainerResumeRefusal, NamesEvaluationsThatAreNone) {
  const std::vector<std::function<void(TrainingState&)>> lies = {
      [](TrainingState& state) {
        state.partial_evaluation = {1, 0, {1, 2, 3}, {1}};
      },  // one episode is all of it
      [](TrainingState& state) { state.partial_evaluation.figures = {1}; },
      [](TrainingState& state) {
        state.partial_evaluation.scores = {1, 2, 3};
      },
      [](TrainingState& state) { state.partial_evaluation.successes = -1; },
      [](TrainingState& state) { state.partial_evaluation.episodes = -1; },
      [](TrainingState& state) { state.last_evaluation->figures.pop_back(); },
      [](TrainingState& state) { state.last_evaluation->scores.pop_back(); },
      [](TrainingState& state) { state.best->evaluation.figures.push_back(0); },
      [](TrainingState& state) { state.delivered = Evaluation{}; },
  };
  for (const auto& lie : lies) {
    const TrainingState saved = state_;
    lie(state_);
    EXPECT_THAT(Refusal(), HasSubstr("an evaluation ")) << &lie - lies.data();
    state_ = saved;
  }
}

TEST_F(TrainerResumeRefusal, NamesADeliveryOfNothingOrBeforeTheEnd) {
  state_.progress.delivering = true;
  EXPECT_THAT(Refusal(), HasSubstr("before the training is over"));
  state_.best.reset();
  EXPECT_THAT(Refusal(), HasSubstr("but has none"));
}

TEST_F(TrainerResumeRefusal, NamesASizeThatIsNotTheNetworks) {
  state_.adam.second_moment.resize(3);
  EXPECT_THAT(Refusal(), HasSubstr("found 3"));
}

}  // namespace
}  // namespace fresco
