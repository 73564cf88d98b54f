#include "report/run_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "msgs/experiment.h"
#include "tests/msgs/message_samples.h"

namespace fresco {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr int64_t kRun = 42;

class RunWatchTest : public ::testing::Test {
 protected:
  template <class Message>
  void Send(RunWatch& watch, const std::string& channel, const Message& message) {
    std::vector<std::byte> bytes;
    Encode(message, bytes);
    watch.Add({.channel = channel, .message = bytes}, now_us_);
  }

  void Announce(RunWatch& watch, const std::string& configuration) {
    const Experiment experiment = Experiment::Parse(configuration, "a test");
    for (run_t part : Announcement(experiment.Text(), 300)) {
      part.run_id = kRun;
      Send(watch, channels_.run, part);
    }
    for (world_t part : WorldMessages(experiment.world())) {
      part.run_id = kRun;
      Send(watch, channels_.world, part);
    }
  }

  learner_status_t Status(int64_t episodes, double score, double best) {
    constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();
    learner_status_t status{};
    status.run_id = kRun;
    status.episodes = episodes;
    status.total_episodes = 1000;
    status.updates = 10 * episodes;
    status.score = score;
    status.best_score = best;
    status.success = 1;
    status.score_bound = status.gap_percent = status.gap_worst_percent = status.gap_median_percent =
        kNotKnown;
    return status;
  }

  const Channels channels_ = ChannelsWithPrefix("FRESCO");
  int64_t now_us_ = 1'000'000;
};

TEST_F(RunWatchTest, ShowsTheReferencePoliciesOfTheAnnouncedWorld) {
  RunWatch watch(channels_);
  Announce(watch, "");
  Send(watch, channels_.learner_status, Status(100, 20, 20));
  // As `fresco evaluate --policy aoi` and `--policy distance` say of an empty file.
  EXPECT_THAT(watch.Text(now_us_), HasSubstr("AoI-based 6.957, distance-based 6.952"));
}

TEST_F(RunWatchTest, RunsNoCodeThatTheBusNames) {
  RunWatch watch(channels_);
  const std::string configuration = "plugin { library: \"/no/such/library.so\" }";
  for (run_t part : Announcement(configuration, 300)) {
    part.run_id = kRun;
    Send(watch, channels_.run, part);
  }
  Send(watch, channels_.learner_status, Status(100, 20, 20));
  EXPECT_THAT(watch.Text(now_us_), Not(HasSubstr("for comparison")));
}

TEST_F(RunWatchTest, ShowsProgressTimeLeftAndTheCurve) {
  RunWatch watch(channels_, kRun);
  Announce(watch, "");
  Send(watch, channels_.learner_status, Status(100, 20, 20));
  now_us_ += 10'000'000;
  Send(watch, channels_.learner_status, Status(200, 15, 15));
  now_us_ += 10'000'000;
  Send(watch, channels_.learner_status, Status(500, 18, 15));
  const std::string text = watch.Text(now_us_);
  // 400 episodes took 20 s, so 500 take 25 s.
  EXPECT_THAT(text, HasSubstr("[###############               ] about 25 s left"));
  EXPECT_THAT(text, HasSubstr("average AoI [slots]: * best so far, . evaluations\n       20 |***"));
  EXPECT_THAT(text, HasSubstr("5000 updates"));
  EXPECT_THAT(text, Not(HasSubstr("messages/s on the bus")));
  for (size_t begin = 0; begin < text.size(); begin = text.find('\n', begin) + 1) {
    EXPECT_LT(text.find('\n', begin) - begin, 80U) << text.substr(begin, 100);
  }
}

TEST_F(RunWatchTest, ShowsOneRunOnlyIfItIsAskedTo) {
  RunWatch watch(channels_, kRun + 1);
  Send(watch, channels_.learner_status, Status(100, 20, 20));
  EXPECT_FALSE(watch.HasRun());
  EXPECT_EQ(watch.Text(now_us_), "");
}

TEST_F(RunWatchTest, FliesNoEndlessReferences) {
  for (const bool endless : {false, true}) {
    RunWatch watch(channels_);
    Announce(watch,
             std::string("scenario { slots: 300 initial_energy_j: 1e5 random_sensors { per_episode: true } } "
                         "agent { set_network {} } schedule { fixed_evaluation_episodes: true "
                         "evaluation_episodes: ") +
                 (endless ? "1000 }" : "3 }"));
    Send(watch, channels_.learner_status, Status(100, 20, 20));
    EXPECT_EQ(watch.Text(now_us_).find("for comparison") == std::string::npos, endless);
  }
}

TEST_F(RunWatchTest, SurvivesAbsurdActors) {
  RunWatch watch(channels_);
  learner_status_t learner = Status(100, 20, 20);
  learner.current_version = std::numeric_limits<int32_t>::min();
  Send(watch, channels_.learner_status, learner);
  actor_status_t actor{};
  actor.run_id = kRun;
  actor.actor_id = 5;
  actor.host = "\x1b[31mred";
  actor.transitions_per_s = actor.weights_latency_ms = std::numeric_limits<float>::max();
  actor.held_count = 1;
  actor.held = {{}};
  actor.held[0].version = std::numeric_limits<int32_t>::max();
  Send(watch, channels_.actor_status, actor);
  const std::string text = watch.Text(now_us_);
  EXPECT_THAT(text, HasSubstr(" [31mred:0"));
  EXPECT_THAT(text, Not(HasSubstr("\x1b")));
  EXPECT_LT(text.size(), 1000U);
}

TEST_F(RunWatchTest, SurvivesAbsurdAndRepeatedStatuses) {
  RunWatch watch(channels_);
  Announce(watch, "");
  const auto send = [&](int64_t updates, double score) {
    learner_status_t status = Status(100, score, score);
    status.updates = updates;
    status.warning = "\x1b[2J\nclear";
    Send(watch, channels_.learner_status, status);
  };
  for (const int64_t updates : {int64_t{1000}, int64_t{2000}, int64_t{3000}, int64_t{1500}, int64_t{0},
                                int64_t{1} << 62, -(int64_t{1} << 62), int64_t{700}, int64_t{800}}) {
    send(updates, 10 + 1e-3 * static_cast<double>(updates % 1000));
    watch.Text(now_us_);
  }
  for (const double score : {1e308, -1.7e308, std::numeric_limits<double>::infinity(), 1.0}) {
    send(900, score);
    const std::string text = watch.Text(now_us_);
    EXPECT_LT(text.size(), 5000U);
    EXPECT_THAT(text, Not(HasSubstr("\x1b")));
  }
  // A run that was resumed goes back; what it did before is forgotten.
  EXPECT_THAT(watch.Text(now_us_), HasSubstr("900 updates"));
}

TEST_F(RunWatchTest, KeepsABoundedNumberOfEvaluations) {
  RunWatch watch(channels_);
  for (int64_t i = 1; i < 20'000; ++i) {
    Send(watch, channels_.learner_status, Status(i, 20 + static_cast<double>(i % 7), 20));
  }
  EXPECT_THAT(watch.Text(now_us_), HasSubstr("199990 updates"));
}

}  // namespace
}  // namespace fresco
