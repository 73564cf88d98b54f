// The orders that a trainer writes, against what the schedule says of them by hand. The small run:
// every training episode has 13 transitions (the mask keeps it in the air until slot 14), an update
// every 2 transitions from the 40th on, a version every 7 updates, a target copy every 20.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <vector>

#include "tests/training/literal_run.h"
#include "training/schedules.h"

namespace fresco {
namespace {

constexpr int64_t kWindow = 6;
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

std::vector<Order> TrainingOrders(const RecordedRun& run) {
  std::vector<Order> training;
  std::copy_if(run.orders.begin(), run.orders.end(), std::back_inserter(training),
               [](const Order& order) { return order.kind == OrderKind::kTrain; });
  return training;
}

/// Training episodes that are committed when the training order with this number is written.
int64_t CommittedBefore(int64_t number) {
  return std::max<int64_t>(0, number - kWindow + 1);
}

TEST(TrainerOrders, CountWithoutGap) {
  FinishedRun run;
  // By hand: 371 updates, 53 versions; evaluated are 4, 8, .. 52 and in the end the last.
  ASSERT_EQ(run.orders.size(), static_cast<size_t>(kEpisodes + 13 + 1));
  for (size_t index = 0; index < run.orders.size(); ++index) {
    EXPECT_EQ(run.orders[index].index, static_cast<int64_t>(index));
  }
  EXPECT_EQ(TrainingOrders(run, run.orders.size()), kEpisodes);
}

TEST(TrainerOrders, CarryASeedOfTheirOwnForEveryTrainingEpisode) {
  FinishedRun run;
  RecordedRun other(Settings{{"schedule.seed", "6"}});
  std::set<uint64_t> seeds;
  for (const Order& order : TrainingOrders(run)) {
    EXPECT_EQ(order.seed, EpisodeSeed(5, static_cast<int64_t>(seeds.size())));
    seeds.insert(order.seed);
  }
  EXPECT_EQ(seeds.size(), static_cast<size_t>(kEpisodes));
  EXPECT_FALSE(seeds.contains(other.orders.front().seed));
}

TEST(TrainerOrders, SearchAsOftenAsTheScheduleSaysAndMostlyFromEarlyOn) {
  const Experiment experiment =
      SmallExperiment({{"schedule.search.share", "0.25"}, {"schedule.search.width", "3"}});
  constexpr int kDraws = 20000;
  constexpr int kLongest = 10;
  std::vector<int> count(kLongest);
  for (int64_t episode = 0; episode < kDraws; ++episode) {
    if (const auto from = SearchedFrom(experiment.schedule(), episode, kLongest)) {
      ++count.at(static_cast<size_t>(*from));
    }
  }
  // By hand: the product of two uniform numbers is below x with probability x - x log x.
  const auto below = [](double x) { return x > 0 ? x - x * std::log(x) : 0; };
  for (int from = 0; from < kLongest; ++from) {
    const double expected = 0.25 * (below((from + 1) / 10.0) - below(from / 10.0));
    EXPECT_NEAR(count[static_cast<size_t>(from)], kDraws * expected, 5 * std::sqrt(kDraws * expected))
        << from;
  }
}

TEST(TrainerOrders, SearchOnlyIfTheyAreForTraining) {
  RecordedRun run(Settings{{"schedule.search.share", "1"}, {"schedule.search.width", "3"}});
  run.Finish();
  for (const Order& order : run.orders) {
    EXPECT_EQ(order.search_width, order.kind == OrderKind::kTrain ? 3 : 0);
    EXPECT_TRUE(SearchFits(order, run.experiment.schedule(), run.experiment.world().longest_episode()));
  }
  RecordedRun without;
  EXPECT_EQ(without.orders.front().search_width, 0);
}

TEST(TrainerOrders, KeepTheWindowFullOfTrainingOrdersUntilTheseRunOut) {
  RecordedRun run;
  EXPECT_EQ(run.orders_at_begin, static_cast<size_t>(kWindow));
  run.Finish();
  for (size_t committed = 1; committed <= run.episodes.size(); ++committed) {
    const size_t written = run.orders_written[committed - 1];
    const int64_t episodes = TrainingOrders(run, committed);
    EXPECT_EQ(TrainingOrders(run, written) - episodes, std::min(kWindow, kEpisodes - episodes)) << committed;
    EXPECT_LE(static_cast<int64_t>(written - committed), MaximumOrdersInFlight(run.experiment.schedule()))
        << committed;
  }
  EXPECT_EQ(run.orders_written.back(), run.episodes.size());
}

TEST(TrainerOrders, NameTheVersionsOfTheMomentWhenTheEpisodeAWindowBeforeWasCommitted) {
  FinishedRun run;
  int64_t number = 0;
  for (const Order& order : TrainingOrders(run)) {
    const int64_t updates = UpdatesAfter(CommittedBefore(number));
    EXPECT_EQ(order.current_version, updates / 7) << number;
    EXPECT_EQ(order.target_version, updates / 20) << number;
    ++number;
  }
  EXPECT_GT(TrainingOrders(run).back().current_version, 40);
}

TEST(TrainerOrders, ExploreByTheLadderOfTheTrainingEpisodes) {
  FinishedRun run;
  int64_t episode = 0;
  for (const Order& order : run.orders) {
    if (order.kind == OrderKind::kTrain) {
      EXPECT_NEAR(order.epsilon, std::pow(0.4, 1 + static_cast<double>(episode % 8)), 1e-7) << episode;
      ++episode;
    } else {
      EXPECT_EQ(order.epsilon, 0) << order.index;
    }
  }
}

TEST(TrainerOrders, ExploreLessWithEveryTransitionCommittedWhenTheyAreWritten) {
  FinishedRun run(Settings{{"schedule.linear.decrement", "0.002"}, {"schedule.linear.minimum", "0.1"}});
  int64_t number = 0;
  for (const Order& order : TrainingOrders(run)) {
    const auto transitions = static_cast<double>(kTransitions * CommittedBefore(number));
    EXPECT_NEAR(order.epsilon, std::max(0.1, 0.9 - 0.002 * transitions), 1e-12) << number;
    ++number;
  }
}

TEST(TrainerOrders, EvaluateBesideTheNextTrainingOrderOnceFourVersionsMoreAreThere) {
  FinishedRun run;
  std::vector<int64_t> found;
  for (size_t committed = 1; committed <= run.episodes.size(); ++committed) {
    const size_t before = committed == 1 ? run.orders_at_begin : run.orders_written[committed - 2];
    for (size_t index = before; index < run.orders_written[committed - 1]; ++index) {
      if (run.orders[index].kind == OrderKind::kEvaluate) {
        EXPECT_EQ(index, before) << "the evaluation comes first";
        EXPECT_EQ(run.orders[index].current_version, UpdatesAfter(TrainingOrders(run, committed)) / 7);
        found.push_back(TrainingOrders(run, committed));
      }
    }
  }
  std::vector<int64_t> expected;
  for (int64_t episode = 1; episode < kEpisodes; ++episode) {
    if (UpdatesAfter(episode - 1) / 7 / 4 != UpdatesAfter(episode) / 7 / 4) {
      expected.push_back(episode);
    }
  }
  expected.push_back(kEpisodes);  // the final evaluation
  EXPECT_EQ(found, expected);
}

TEST(TrainerOrders, AreTheSameForTrainingHoweverManyEvaluationsStandBesideThem) {
  FinishedRun usual;
  // At most one evaluation an episode, and the final one: 371 updates make 53 versions, of which an episode
  // of 6 or 7 updates makes one at most.
  for (const auto& [versions_per_evaluation, evaluations] :
       {std::pair("1", 53u + 1), std::pair("2", 26u + 1), std::pair("1000000", 1u)}) {
    FinishedRun run(Settings{{"schedule.versions_per_evaluation", versions_per_evaluation}});
    // The last version that is due may be the final one.
    EXPECT_NEAR(static_cast<double>(run.evaluations.size()), evaluations, 1) << versions_per_evaluation;
    EXPECT_TRUE(run.trainer.current() == usual.trainer.current()) << versions_per_evaluation;
    const std::vector<Order> expected = TrainingOrders(usual);
    const std::vector<Order> found = TrainingOrders(run);
    ASSERT_EQ(found.size(), expected.size());
    for (size_t number = 0; number < expected.size(); ++number) {
      Order order = found[number];
      order.index = expected[number].index;
      EXPECT_EQ(order, expected[number]) << number;
    }
  }
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
    const int64_t episodes = TrainingOrders(run, run.episodes.size());
    ASSERT_EQ(TrainingOrders(run, run.orders.size()), std::min<int64_t>(9, episodes + 1));
    if (run.next().kind == OrderKind::kTrain) {
      EXPECT_EQ(run.next().current_version, UpdatesAfter(episodes) / 7);
    }
    run.Commit(run.Fly(run.next()));
  }
  EXPECT_EQ(run.trainer.progress().episodes, 9);
}

}  // namespace
}  // namespace fresco
