// A training that is saved and gone on with, by another trainer and through a checkpoint's bytes, against
// the one that was not disturbed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "storage/checkpoint_file.h"
#include "tests/support/error_of.h"
#include "tests/training/literal_run.h"

namespace fresco {
namespace {

using testing::HasSubstr;

/// Through the bytes of a file, as a learner that was killed sees it.
TrainingState FromDisk(const Experiment& experiment, const TrainingState& state) {
  return ParseCheckpoint(SerializeCheckpoint({experiment, 1, 77, state}), "a test").training;
}

/// A trainer that goes on from a state, with everything that it hands out.
struct Resumed {
  Resumed(const RecordedRun& run, const TrainingState& state)
      : trainer(run.experiment, run.world,
                {[this](const Order& order) { orders.push_back(order); },
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
void ExpectTheSameFromEverywhere(const Settings& settings, size_t stride) {
  FinishedRun whole(settings);
  RecordedRun run(settings);
  for (size_t committed = 0; committed < whole.episodes.size(); ++committed) {
    if (committed % stride == 0) {
      Resumed resumed(run, FromDisk(run.experiment, run.trainer.Save()));
      ASSERT_EQ(resumed.orders_at_resume, run.orders.size() - committed);
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
    }
    run.Commit(whole.episodes[committed]);
  }
}

TEST(TrainerResume, GivesTheSameWeightsFromEveryEpisodeOn) {
  ExpectTheSameFromEverywhere({}, 1);
}

TEST(TrainerResume, GivesTheSameWeightsWithBoundsFromWholeEpisodesAndPlainDqn) {
  ExpectTheSameFromEverywhere({{"agent.flown_return_bound", "true"},
                               {"agent.double_dqn", "false"},
                               {"agent.sensor_geometry", "true"},
                               {"agent.exponential.initial", "0.002"},
                               {"schedule.linear.initial", "0.9"}},
                              7);
}

TEST(TrainerResume, GivesTheSameWeightsWhereTheReplayMemoryIsSmallerThanAnEpisode) {
  ExpectTheSameFromEverywhere(
      {{"agent.replay_capacity", "10"}, {"agent.batch_size", "8"}, {"schedule.minimum_replay_size", "4"}}, 5);
}

TEST(TrainerResume, HandsOutTheVersionsThatOrdersInFlightName) {
  RecordedRun run;
  for (int i = 0; i < 30; ++i) {
    run.Commit(run.Fly(run.next()));
  }
  const Resumed resumed(run, run.trainer.Save());
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

TEST_F(TrainerResumeRefusal, NamesActionsThatAreNoEpisodes) {
  state_.actions.back() = 14;  // hovering far from the stop in the last slot
  EXPECT_THAT(Refusal(), HasSubstr("no complete episodes"));
  state_.actions.resize(20);
  EXPECT_THAT(Refusal(), HasSubstr("found 20"));
}

TEST_F(TrainerResumeRefusal, NamesASizeThatIsNotTheNetworks) {
  state_.adam.second_moment.resize(3);
  EXPECT_THAT(Refusal(), HasSubstr("found 3"));
}

}  // namespace
}  // namespace fresco
