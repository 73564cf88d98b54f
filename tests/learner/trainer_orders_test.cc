// The orders that a trainer writes, against what the schedule says of them by hand. The small run:
// every training episode has 13 transitions (the mask keeps it in the air until slot 14), an update
// every 2 transitions from the 40th on, a version every 7 updates, a target copy every 20.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/learner/recorded_run.h"

namespace fresco {
namespace {

constexpr size_t kWindow = 6;
constexpr int64_t kEpisodes = 60;
constexpr int64_t kTransitions = 13;

/// Updates that were made when `episodes` training episodes were committed.
int64_t UpdatesAfter(int64_t episodes) {
  int64_t updates = 0;
  for (int64_t transition = 1; transition <= episodes * kTransitions; ++transition) {
    updates += transition >= 40 && transition % 2 == 0 ? 1 : 0;
  }
  return updates;
}

/// Training orders among the first `count` ones.
int64_t TrainingOrders(const RecordedRun& run, size_t count) {
  return std::count_if(run.orders.begin(), run.orders.begin() + static_cast<int64_t>(count),
                       [](const Order& order) { return order.kind == OrderKind::kTrain; });
}

/// The index behind that of the last training order.
size_t EndOfTrainingOrders(const RecordedRun& run) {
  size_t end = run.orders.size();
  while (run.orders[end - 1].kind != OrderKind::kTrain) {
    --end;
  }
  return end;
}

TEST(TrainerOrders, CountWithoutGapAndCarryTheSeed) {
  RecordedRun run;
  run.Finish();
  // By hand: 371 updates, 53 versions; evaluated are 4, 8, .. 52 and in the end the last.
  ASSERT_EQ(run.orders.size(), static_cast<size_t>(kEpisodes + 13 + 1));
  for (size_t index = 0; index < run.orders.size(); ++index) {
    EXPECT_EQ(run.orders[index].index, static_cast<int64_t>(index));
    EXPECT_EQ(run.orders[index].seed, 5u);
  }
  EXPECT_EQ(TrainingOrders(run, run.orders.size()), kEpisodes);
}

TEST(TrainerOrders, KeepTheWindowFullUntilTheTrainingOrdersRunOut) {
  RecordedRun run;
  EXPECT_EQ(run.orders_at_begin, kWindow);
  run.Finish();
  const size_t end = EndOfTrainingOrders(run);
  for (size_t committed = 1; committed <= run.episodes.size(); ++committed) {
    const size_t before = committed == 1 ? kWindow : run.orders_written[committed - 2];
    const size_t in_flight = run.orders_written[committed - 1] - committed;
    EXPECT_LE(in_flight, kWindow) << committed;
    if (before < end) {
      EXPECT_EQ(in_flight, kWindow) << committed;
    }
  }
  EXPECT_EQ(run.orders_written.back(), run.episodes.size());
}

TEST(TrainerOrders, NameTheVersionsOfTheMomentWhenTheEpisodeAWindowBeforeWasCommitted) {
  RecordedRun run;
  run.Finish();
  const size_t end = EndOfTrainingOrders(run);
  for (size_t index = 0; index < end; ++index) {
    const size_t committed = index < kWindow ? 0 : index - kWindow + 1;
    const int64_t updates = UpdatesAfter(TrainingOrders(run, committed));
    EXPECT_EQ(run.orders[index].current_version, updates / 7) << index;
    EXPECT_EQ(run.orders[index].target_version, updates / 20) << index;
  }
  EXPECT_GT(run.orders[end - 1].current_version, 40);
}

TEST(TrainerOrders, ExploreByTheLadderOfTheTrainingEpisodes) {
  RecordedRun run;
  run.Finish();
  int64_t episode = 0;
  for (const Order& order : run.orders) {
    if (order.kind == OrderKind::kTrain) {
      EXPECT_NEAR(order.epsilon, std::pow(0.4, 1 + static_cast<double>(episode % 8)), 1e-15) << episode;
      ++episode;
    } else {
      EXPECT_EQ(order.epsilon, 0) << order.index;
    }
  }
}

TEST(TrainerOrders, ExploreLessWithEveryTransitionCommittedWhenTheyAreWritten) {
  RecordedRun run(Settings{{"schedule.linear.decrement", "0.002"}, {"schedule.linear.minimum", "0.1"}});
  run.Finish();
  for (size_t index = 0; index < EndOfTrainingOrders(run); ++index) {
    const size_t committed = index < kWindow ? 0 : index - kWindow + 1;
    const auto transitions = static_cast<double>(kTransitions * TrainingOrders(run, committed));
    const double expected =
        run.orders[index].kind == OrderKind::kEvaluate ? 0 : std::max(0.1, 0.9 - 0.002 * transitions);
    EXPECT_NEAR(run.orders[index].epsilon, expected, 1e-12) << index;
  }
}

TEST(TrainerOrders, EvaluateWithTheNextOrderOnceFourVersionsMoreAreThere) {
  RecordedRun run;
  run.Finish();
  const size_t end = EndOfTrainingOrders(run);
  int evaluations = 0;
  for (size_t index = kWindow; index < end; ++index) {
    const int64_t before = UpdatesAfter(TrainingOrders(run, index - kWindow)) / 7;
    const int64_t after = UpdatesAfter(TrainingOrders(run, index - kWindow + 1)) / 7;
    const bool due = before / 4 != after / 4;
    EXPECT_EQ(run.orders[index].kind == OrderKind::kEvaluate, due) << index;
    evaluations += due ? 1 : 0;
  }
  EXPECT_GE(evaluations, 11);
}

TEST(TrainerOrders, AreNoMoreThanTheEpisodesWhereTheWindowIsLarger) {
  RecordedRun run(Settings{{"schedule.episodes", "3"}});
  ASSERT_EQ(run.orders.size(), 3u);
  run.Finish();
  ASSERT_EQ(run.orders.size(), 4u);
  EXPECT_EQ(run.orders_written, (std::vector<size_t>{3, 3, 4, 4}));  // the final evaluation, once all is in
  EXPECT_EQ(run.orders[3].kind, OrderKind::kEvaluate);
  EXPECT_EQ(run.orders[3].current_version, 0);  // 39 transitions: not an update
}

TEST(TrainerOrders, FollowOneByOneInAWindowOfOne) {
  RecordedRun run(Settings{{"schedule.window", "1"}, {"schedule.episodes", "9"}});
  while (!run.trainer.finished()) {
    ASSERT_EQ(run.orders.size(), run.episodes.size() + 1);
    if (run.next().kind == OrderKind::kTrain) {
      EXPECT_EQ(run.next().current_version, UpdatesAfter(TrainingOrders(run, run.episodes.size())) / 7);
    }
    run.Commit(run.Fly(run.next()));
  }
  EXPECT_EQ(run.trainer.progress().episodes, 9);
}

}  // namespace
}  // namespace fresco
