#include "training/ledger.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "core/random.h"
#include "tests/training/literal_run.h"

namespace fresco {
namespace {

bool SameEpisode(const Episode& a, const Episode& b) {
  const auto same_state = [](const State& x, const State& y) {
    return x.slot == y.slot && x.cell == y.cell && x.time_margin == y.time_margin &&
           x.energy_margin_j == y.energy_margin_j && x.aoi == y.aoi;
  };
  return a.order_index == b.order_index && a.outcome == b.outcome && a.actions == b.actions &&
         a.rewards == b.rewards && a.td_errors == b.td_errors && a.next_masks == b.next_masks &&
         std::equal(a.states.begin(), a.states.end(), b.states.begin(), b.states.end(), same_state);
}

class LedgerTest : public ::testing::Test {
 protected:
  LedgerTest()
      : experiment_(SmallExperiment()),
        world_(experiment_.scenario()),
        ledger_(world_, experiment_.mask_options()) {
    const auto parameters = std::make_shared<const Vector>(InitialParameters(experiment_.network_shape(), 1));
    for (int64_t index = 0; index < kOrders; ++index) {
      Order order;
      order.index = index;
      order.epsilon = 0.7;
      order.seed = 3 + static_cast<uint64_t>(index);
      ledger_.Write(order);
      episodes_.push_back(FlyOrder(world_, experiment_, order, parameters, parameters));
      for (int first = 0; first < episodes_.back().transitions(); first += 5) {
        runs_.push_back(
            PartOf(world_, episodes_.back(), first, std::min(5, episodes_.back().transitions() - first)));
      }
    }
  }

  static constexpr int64_t kOrders = 6;
  Experiment experiment_;
  World world_;
  Ledger ledger_;
  std::vector<Episode> episodes_;
  std::vector<Episode> runs_;
};

TEST_F(LedgerTest, CommitsInOrderWhateverTheArrival) {
  RandomStream stream(1, RandomPurpose::kTest, 0, 0);
  std::vector<Episode> arriving = runs_;
  arriving.insert(arriving.end(), runs_.begin(), runs_.end());  // everything twice
  for (size_t i = arriving.size(); i > 1; --i) {
    std::swap(arriving[i - 1], arriving[stream.NextBelow(static_cast<uint32_t>(i))]);
  }
  int64_t next = 0;
  for (const Episode& run : arriving) {
    ledger_.Add(run);
    while (const auto committed = ledger_.TakeNext()) {
      EXPECT_EQ(committed->order.index, next);
      EXPECT_TRUE(SameEpisode(committed->episode, episodes_[static_cast<size_t>(next)]));
      ++next;
    }
  }
  EXPECT_EQ(next, kOrders);
  EXPECT_EQ(ledger_.committed(), kOrders);
  EXPECT_EQ(ledger_.in_flight(), 0);
}

TEST_F(LedgerTest, SaysWhatARunBrought) {
  EXPECT_EQ(ledger_.Add(runs_[0]), Ledger::Arrival::kAccepted);
  EXPECT_EQ(ledger_.Add(runs_[0]), Ledger::Arrival::kDuplicate);
  EXPECT_EQ(ledger_.Add(runs_[1]), Ledger::Arrival::kAccepted);
  EXPECT_EQ(ledger_.Add(runs_[2]), Ledger::Arrival::kCompleted);
  EXPECT_EQ(ledger_.Add(runs_[1]), Ledger::Arrival::kDuplicate);
  ASSERT_TRUE(ledger_.TakeNext());
  EXPECT_EQ(ledger_.Add(runs_[1]), Ledger::Arrival::kDuplicate);
  EXPECT_FALSE(ledger_.TakeNext());
  Episode unknown = episodes_[0];
  unknown.order_index = kOrders;
  EXPECT_EQ(ledger_.Add(unknown), Ledger::Arrival::kUnknownOrder);
}

TEST_F(LedgerTest, TakesRunsThatOverlapAsLongAsTheyAgree) {
  EXPECT_EQ(ledger_.Add(PartOf(world_, episodes_[0], 2, 6)), Ledger::Arrival::kAccepted);
  EXPECT_EQ(ledger_.Add(PartOf(world_, episodes_[0], 0, 5)), Ledger::Arrival::kAccepted);
  EXPECT_EQ(ledger_.Add(PartOf(world_, episodes_[0], 3, 4)), Ledger::Arrival::kDuplicate);
  EXPECT_EQ(ledger_.Add(PartOf(world_, episodes_[0], 7, 6)), Ledger::Arrival::kCompleted);
  EXPECT_TRUE(SameEpisode(ledger_.TakeNext()->episode, episodes_[0]));
}

TEST_F(LedgerTest, KeepsNoMoreThanTwoEpisodesForAnOrder) {
  Ledger::Arrival arrival = Ledger::Arrival::kAccepted;
  int kept = 0;
  for (int last = 1; arrival == Ledger::Arrival::kAccepted; ++last) {  // each brings one transition more
    kept += last;
    arrival = ledger_.Add(PartOf(world_, episodes_[0], 0, last));
  }
  EXPECT_EQ(arrival, Ledger::Arrival::kInconsistent);
  EXPECT_GT(kept, 2 * world_.maximum_transitions());
  EXPECT_LT(kept, 3 * world_.maximum_transitions());
  EXPECT_EQ(ledger_.Add(episodes_[0]), Ledger::Arrival::kCompleted);
}

TEST_F(LedgerTest, RefusesWhatDoesNotFollowFromItsActionsAndTakesItRightLater) {
  const std::vector<std::function<void(Episode&)>> lies = {
      [](Episode& episode) { episode.rewards[3] += 0.01f; },
      [](Episode& episode) { episode.states[4].aoi[1] = 1 + episode.states[4].aoi[1] % 3; },
      [](Episode& episode) { episode.states[2].energy_margin_j += 1; },
      [](Episode& episode) { episode.states[5].time_margin += 1; },
      [](Episode& episode) { episode.next_masks[1] ^= 1; },
      [](Episode& episode) { episode.outcome = Outcome::kOutOfTime; },
      [](Episode& episode) {
        std::swap(episode.states[0].cell.column, episode.states[3].cell.row);
        episode.states[0].cell.column += 1;
      },
  };
  for (const auto& lie : lies) {
    Episode false_episode = episodes_[0];
    lie(false_episode);
    EXPECT_EQ(ledger_.Add(false_episode), Ledger::Arrival::kInconsistent);
    EXPECT_FALSE(ledger_.TakeNext());
  }
  EXPECT_EQ(ledger_.Add(episodes_[0]), Ledger::Arrival::kCompleted);
  EXPECT_TRUE(SameEpisode(ledger_.TakeNext()->episode, episodes_[0]));
}

}  // namespace
}  // namespace fresco
