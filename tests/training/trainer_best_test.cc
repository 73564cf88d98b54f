// Which network a trainer keeps as the best one. A trainer takes the episodes that it is given, so
// the results of the evaluations are chosen here: flights of random policies, good and bad.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "tests/training/literal_run.h"
#include "worlds/uav/flight.h"

namespace fresco {
namespace {

/// J of a flight: the mean over 14 slots of (1 delta_1 + 2 delta_2) / 3; what ended early grows on.
double LiteralAverageAoi(const Episode& episode) {
  double sum = 0;
  for (int slot = 1; slot <= 14; ++slot) {
    const int last = episode.transitions() + 1;
    const UavState state = StateIn(episode, static_cast<size_t>(std::min(slot, last)) - 1);
    const int later = std::max(0, slot - last);
    sum += (std::min(state.aoi[0] + later, 14) + 2 * std::min(state.aoi[1] + later, 14)) / 3.0;
  }
  return sum / 14;
}

/// Every update makes a version, and every version wants an evaluation.
class TrainerBest : public ::testing::Test {
 protected:
  TrainerBest()
      : run_(Settings{{"schedule.updates_per_version", "1"},
                      {"schedule.versions_per_evaluation", "1"},
                      {"schedule.minimum_replay_size", "1"},
                      {"schedule.window", "3"},
                      {"agent.safe_action_mask", "false"}}) {
    for (uint64_t seed = 0; arrivals_.size() < 3 || failures_.size() < 2; ++seed) {
      AddFlight(seed);
    }
    std::sort(arrivals_.begin(), arrivals_.end(),
              [](const Episode& a, const Episode& b) { return LiteralAverageAoi(a) < LiteralAverageAoi(b); });
  }

  void AddFlight(uint64_t seed) {
    Order order;
    order.epsilon = 1;
    order.seed = seed;
    const Episode flight = run_.Fly(order);
    const auto same = [&](const Episode& other) {
      return LiteralAverageAoi(other) == LiteralAverageAoi(flight);
    };
    auto& flights = Arrived(flight) ? arrivals_ : failures_;
    if (std::none_of(flights.begin(), flights.end(), same)) {
      flights.push_back(flight);
    }
  }

  /// Trains to the next evaluation, which gives `result`; returns the version that was evaluated.
  int64_t Evaluate(const Episode& result) {
    while (run_.next().kind == OrderKind::kTrain) {
      run_.Commit(run_.Fly(run_.next()));
    }
    const int64_t version = run_.next().current_version;
    run_.Commit(result);
    EXPECT_EQ(run_.evaluations.back().version, version);
    EXPECT_EQ(run_.evaluations.back().updates, version);
    EXPECT_EQ(run_.evaluations.back().success, Arrived(result) ? 1 : 0);
    EXPECT_NEAR(run_.evaluations.back().score(), LiteralAverageAoi(result), 1e-12);
    return version;
  }

  void ExpectBest(int64_t version) {
    const BestNetwork& best = run_.trainer.best().value();
    EXPECT_EQ(best.evaluation.version, version);
    EXPECT_TRUE(*best.parameters == run_.weights[static_cast<size_t>(version)]);
  }

  RecordedRun run_;
  std::vector<Episode> arrivals_;  // the best first
  std::vector<Episode> failures_;
};

TEST_F(TrainerBest, IsNoneBeforeTheFirstEvaluation) {
  EXPECT_FALSE(run_.trainer.best().has_value());
  EXPECT_FALSE(run_.trainer.last_evaluation().has_value());
}

TEST_F(TrainerBest, IsTheLastOneUntilOneArrives) {
  ExpectBest(Evaluate(failures_[0]));
  ExpectBest(Evaluate(failures_[1]));
  ExpectBest(Evaluate(failures_[0]));
  ExpectBest(Evaluate(arrivals_[2]));
}

TEST_F(TrainerBest, ArrivedWhateverTheAoiOfThoseThatDidNot) {
  const int64_t arrived = Evaluate(arrivals_[2]);
  Evaluate(failures_[0]);
  Evaluate(failures_[1]);
  ExpectBest(arrived);
  EXPECT_EQ(run_.trainer.last_evaluation()->success, 0);
}

TEST_F(TrainerBest, HasTheSmallestAverageAoiAndIsTheEarliestOfEquals) {
  const int64_t middle = Evaluate(arrivals_[1]);
  ExpectBest(middle);
  Evaluate(arrivals_[2]);
  ExpectBest(middle);
  const int64_t smallest = Evaluate(arrivals_[0]);
  ExpectBest(smallest);
  EXPECT_NE(Evaluate(arrivals_[0]), smallest);
  Evaluate(arrivals_[1]);
  ExpectBest(smallest);
}

}  // namespace
}  // namespace fresco
