#include "training/ledger.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "core/random.h"
#include "tests/training/acting_samples.h"
#include "tests/training/literal_run.h"
#include "worlds/uav/flight.h"

namespace fresco {
namespace {

/// Field `field` of state i.
float& FieldOf(Episode& episode, size_t i, size_t field) {
  return episode.states[i * (episode.states.size() / (episode.actions.size() + 1)) + field];
}

class LedgerTest : public ::testing::Test {
 protected:
  LedgerTest() : experiment_(SmallExperiment()), world_(experiment_.world()), ledger_(world_) {
    const auto parameters = std::make_shared<const Vector>(experiment_.network()->InitialParameters(1));
    for (int64_t index = 0; index < kOrders; ++index) {
      Order order;
      order.index = index;
      order.epsilon = 0.7;
      order.seed = 3 + static_cast<uint64_t>(index);
      ledger_.Write(order);
      results_.push_back(FlyOrder(experiment_, order, parameters, parameters));
      const int transitions = results_.back().episode.transitions();
      for (int first = 0; first < transitions; first += 5) {
        parts_.push_back(PartOf(world_, results_.back(), first, std::min(5, transitions - first)));
      }
    }
  }

  static constexpr int64_t kOrders = 6;
  Experiment experiment_;
  const World& world_;
  Ledger ledger_;
  std::vector<OrderResult> results_;
  std::vector<OrderResult> parts_;
};

TEST_F(LedgerTest, CommitsInOrderWhateverTheArrival) {
  RandomStream stream(1, RandomPurpose::kTest, 0, 0);
  std::vector<OrderResult> arriving = parts_;
  arriving.insert(arriving.end(), parts_.begin(), parts_.end());  // everything twice
  for (size_t i = arriving.size(); i > 1; --i) {
    std::swap(arriving[i - 1], arriving[stream.NextBelow(static_cast<uint32_t>(i))]);
  }
  int64_t next = 0;
  for (const OrderResult& part : arriving) {
    ledger_.Add(part);
    while (const auto committed = ledger_.TakeNext()) {
      EXPECT_EQ(committed->order.index, next);
      EXPECT_TRUE(SameBits(committed->episode, results_[static_cast<size_t>(next)].episode));
      ++next;
    }
  }
  EXPECT_EQ(next, kOrders);
  EXPECT_EQ(ledger_.committed(), kOrders);
  EXPECT_EQ(ledger_.in_flight(), 0);
}

TEST_F(LedgerTest, SaysWhatAPartBrought) {
  EXPECT_EQ(ledger_.Add(parts_[0]), Ledger::Arrival::kAccepted);
  EXPECT_EQ(ledger_.Add(parts_[0]), Ledger::Arrival::kDuplicate);
  EXPECT_EQ(ledger_.Add(parts_[1]), Ledger::Arrival::kAccepted);
  EXPECT_EQ(ledger_.Add(parts_[2]), Ledger::Arrival::kCompleted);
  EXPECT_EQ(ledger_.Add(parts_[1]), Ledger::Arrival::kDuplicate);
  ASSERT_TRUE(ledger_.TakeNext());
  EXPECT_EQ(ledger_.Add(parts_[1]), Ledger::Arrival::kDuplicate);
  EXPECT_FALSE(ledger_.TakeNext());
  OrderResult unknown = results_[0];
  unknown.order_index = kOrders;
  EXPECT_EQ(ledger_.Add(unknown), Ledger::Arrival::kUnknownOrder);
}

TEST_F(LedgerTest, TakesPartsThatOverlapAsLongAsTheyAgree) {
  EXPECT_EQ(ledger_.Add(PartOf(world_, results_[0], 2, 6)), Ledger::Arrival::kAccepted);
  EXPECT_EQ(ledger_.Add(PartOf(world_, results_[0], 0, 5)), Ledger::Arrival::kAccepted);
  EXPECT_EQ(ledger_.Add(PartOf(world_, results_[0], 3, 4)), Ledger::Arrival::kDuplicate);
  EXPECT_EQ(ledger_.Add(PartOf(world_, results_[0], 7, 6)), Ledger::Arrival::kCompleted);
  EXPECT_TRUE(SameBits(ledger_.TakeNext()->episode, results_[0].episode));
}

TEST_F(LedgerTest, TakesPartsThatGrowByATransitionEach) {
  const int transitions = results_[0].episode.transitions();
  for (int last = 1; last < transitions; ++last) {
    EXPECT_EQ(ledger_.Add(PartOf(world_, results_[0], 0, last)), Ledger::Arrival::kAccepted);
  }
  EXPECT_EQ(ledger_.Add(results_[0]), Ledger::Arrival::kCompleted);
  EXPECT_TRUE(SameBits(ledger_.TakeNext()->episode, results_[0].episode));
}

TEST_F(LedgerTest, RefusesTheEpisodeOfAnotherSeed) {
  OrderResult other = results_[0];
  other.seed = results_[1].seed;
  EXPECT_EQ(ledger_.Add(other), Ledger::Arrival::kInconsistent);
  EXPECT_EQ(ledger_.Add(parts_[0]), Ledger::Arrival::kAccepted);
  EXPECT_EQ(ledger_.Add(PartOf(world_, other, 5, 5)), Ledger::Arrival::kInconsistent);
  EXPECT_EQ(ledger_.Add(parts_[0]), Ledger::Arrival::kAccepted) << "what had arrived was dropped";
  EXPECT_EQ(ledger_.Add(results_[0]), Ledger::Arrival::kCompleted);
}

TEST_F(LedgerTest, RefusesWhatDoesNotFollowFromItsActionsAndTakesItRightLater) {
  const std::vector<std::function<void(Episode&)>> lies = {
      [](Episode& episode) { episode.rewards[3] += 0.01f; },
      [](Episode& episode) { FieldOf(episode, 4, kAoiField + 1) += 1; },
      [](Episode& episode) { FieldOf(episode, 2, kEnergyMarginField) += 1; },
      [](Episode& episode) { FieldOf(episode, 5, kTimeMarginField) += 1; },
      [](Episode& episode) { FieldOf(episode, 0, kColumnField) += 1; },
      [](Episode& episode) { FieldOf(episode, 13, kRowField) = -FieldOf(episode, 13, kRowField); },
      [](Episode& episode) { episode.next_masks[1] ^= 1; },
      [](Episode& episode) { episode.ending = Ending::kTruncated; },
      [](Episode& episode) { std::swap(episode.actions[1], episode.actions[2]); },
  };
  for (const auto& lie : lies) {
    OrderResult false_result = results_[0];
    lie(false_result.episode);
    EXPECT_EQ(ledger_.Add(false_result), Ledger::Arrival::kInconsistent);
    EXPECT_FALSE(ledger_.TakeNext());
  }
  EXPECT_EQ(ledger_.Add(results_[0]), Ledger::Arrival::kCompleted);
  EXPECT_TRUE(SameBits(ledger_.TakeNext()->episode, results_[0].episode));
}

}  // namespace
}  // namespace fresco
