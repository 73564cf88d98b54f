// When a run is announced, and what joins its announcement again.
#include "learner/run_announcer.h"

#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include "msgs/protocol_times.h"
#include "msgs/run_announcements.h"
#include "tests/training/literal_run.h"

namespace fresco {
namespace {

class RunAnnouncerTest : public ::testing::Test {
 protected:
  static constexpr int64_t kRunId = 0x2b;
  static constexpr int64_t kNowUtime = 1'700'000'000'000'000;

  RunAnnouncerTest() { spdlog::set_level(spdlog::level::off); }

  bool IsForeign(int64_t run_id, int64_t utime, bool finished = false) {
    run_t message{};
    message.run_id = run_id;
    message.utime = utime;
    message.finished = finished ? 1 : 0;
    return announcer_.IsForeign(message, "RUN", kNowUtime);
  }

  Experiment experiment_ = SmallExperiment();
  RunAnnouncer announcer_{experiment_, kRunId};
};

TEST_F(RunAnnouncerTest, IsDueAtOnceAndThenOnceAPeriod) {
  EXPECT_TRUE(announcer_.IsDue(0));
  EXPECT_FALSE(announcer_.IsDue(kRunPeriodUs - 1));
  EXPECT_TRUE(announcer_.IsDue(kRunPeriodUs));
  EXPECT_FALSE(announcer_.IsDue(2 * kRunPeriodUs - 1));
}

TEST_F(RunAnnouncerTest, IsDueSoonerOnceIfAnActorAsks) {
  EXPECT_TRUE(announcer_.IsDue(0));
  announcer_.Ask();
  EXPECT_FALSE(announcer_.IsDue(kAskedRunPeriodUs - 1));
  EXPECT_TRUE(announcer_.IsDue(kAskedRunPeriodUs));
  EXPECT_FALSE(announcer_.IsDue(2 * kAskedRunPeriodUs));
}

TEST_F(RunAnnouncerTest, SaysWhatJoinsToTheConfiguration) {
  TrainerProgress progress;
  progress.current_version = 5;
  RunAnnouncements joined;
  std::optional<std::string> text;
  for (const run_t& message : announcer_.Messages(progress, true)) {
    EXPECT_FALSE(text) << "a part too many";
    EXPECT_EQ(message.current_version, 5);
    EXPECT_EQ(message.finished, 1);
    EXPECT_EQ(message.part_size, static_cast<int32_t>(message.part.size()));
    text = joined.Add(message);
  }
  EXPECT_EQ(text, experiment_.Text());
}

TEST_F(RunAnnouncerTest, KnowsItsOwnRunOnceItHasAnnouncedIt) {
  EXPECT_TRUE(IsForeign(kRunId, kNowUtime)) << "another learner resumed this run";
  announcer_.Messages({}, false);
  EXPECT_FALSE(IsForeign(kRunId, kNowUtime));
  EXPECT_TRUE(IsForeign(kRunId + 1, kNowUtime));
}

TEST_F(RunAnnouncerTest, NamesTheOtherRunOnlyIfItGoesOnNow) {
  EXPECT_TRUE(IsForeign(kRunId + 1, kNowUtime, true));
  EXPECT_TRUE(IsForeign(kRunId + 2, kNowUtime - kClockToleranceUs - 1));
  EXPECT_EQ(announcer_.foreign_run(), 0);
  EXPECT_TRUE(IsForeign(kRunId + 3, kNowUtime));
  EXPECT_EQ(announcer_.foreign_run(), kRunId + 3);
}

}  // namespace
}  // namespace fresco
