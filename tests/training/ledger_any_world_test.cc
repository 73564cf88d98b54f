// The ledger in worlds that differ from the UAV's: states too long for one message, episodes that are cut
// off, and results that can't be flown again.
#include <gtest/gtest.h>

#include <functional>
#include <utility>
#include <vector>

#include "core/random.h"
#include "tests/worlds/play.h"
#include "tests/worlds/walk_world.h"
#include "training/ledger.h"

namespace fresco {
namespace {

constexpr int kFields = 400;  // three messages for each transition

WorldDescription WideWalk(bool repeatable) {
  WorldDescription description = WalkWorld::WideDescription(kFields);
  description.repeatable = repeatable;
  return description;
}

/// The parameter says whether the world is repeatable.
class LedgerOfWideStates : public ::testing::TestWithParam<bool> {
 protected:
  LedgerOfWideStates() {
    for (int64_t index = 0; index < kOrders; ++index) {
      Order order;
      order.index = index;
      order.seed = static_cast<uint64_t>(index);  // begins at this place
      ledger_.Write(order);
      OrderResult result{index, order.seed, 0, 0, Play(world_, order.seed, RandomActions(order.seed, 9)), {}};
      result.td_errors.resize(result.episode.actions.size());
      parts_.emplace_back();
      SplitResult(world_, result, 7, [&](const transitions_t& message) {
        ASSERT_TRUE(FromWire(world_, message, parts_.back().emplace_back()));
      });
      results_.push_back(std::move(result));
    }
  }

  void ExpectNext(int64_t index) {
    const auto committed = ledger_.TakeNext();
    ASSERT_TRUE(committed.has_value());
    EXPECT_EQ(committed->order.index, index);
    EXPECT_TRUE(SameBits(committed->episode, results_[static_cast<size_t>(index)].episode));
  }

  /// Adds all parts of order 0; the last one completes it.
  void ExpectToTakeTheFirstOrder() {
    for (const OrderResult& part : parts_[0]) {
      EXPECT_EQ(ledger_.Add(part),
                &part == &parts_[0].back() ? Ledger::Arrival::kCompleted : Ledger::Arrival::kAccepted);
    }
    ExpectNext(0);
  }

  static constexpr int64_t kOrders = 10;
  WalkWorld world_{WideWalk(GetParam())};
  Ledger ledger_{world_};
  std::vector<OrderResult> results_;             // by order
  std::vector<std::vector<OrderResult>> parts_;  // of each order, as messages bring them
};

TEST_P(LedgerOfWideStates, SeesWhatItIsMadeFor) {
  int endings[3] = {};
  for (size_t order = 0; order < results_.size(); ++order) {
    ASSERT_EQ(parts_[order].size(), 3 * results_[order].episode.actions.size());
    ++endings[static_cast<size_t>(results_[order].episode.ending)];
  }
  EXPECT_EQ(endings[0], 0);
  EXPECT_GT(endings[static_cast<size_t>(Ending::kTerminal)], 0);
  EXPECT_GT(endings[static_cast<size_t>(Ending::kTruncated)], 0);
}

TEST_P(LedgerOfWideStates, CommitsInOrderWhateverTheArrival) {
  std::vector<OrderResult> arriving;
  for (const auto& parts : parts_) {
    arriving.insert(arriving.end(), parts.begin(), parts.end());
    arriving.insert(arriving.end(), parts.begin(), parts.end());  // everything twice
  }
  RandomStream stream(1, RandomPurpose::kTest, 0, 0);
  for (size_t i = arriving.size(); i > 1; --i) {
    std::swap(arriving[i - 1], arriving[stream.NextBelow(static_cast<uint32_t>(i))]);
  }
  int64_t next = 0;
  for (const OrderResult& part : arriving) {
    EXPECT_NE(ledger_.Add(part), Ledger::Arrival::kInconsistent);
    while (next < kOrders && ledger_.IsComplete(next)) {
      ExpectNext(next++);
      if (next == kOrders) {
        break;
      }
    }
  }
  EXPECT_EQ(next, kOrders);
  EXPECT_FALSE(ledger_.TakeNext());
}

TEST_P(LedgerOfWideStates, WaitsForEveryField) {
  for (size_t order = 0; order < parts_.size(); ++order) {
    const size_t missing = order % parts_[order].size();
    for (size_t i = 0; i < parts_[order].size(); ++i) {
      if (i != missing) {
        EXPECT_EQ(ledger_.Add(parts_[order][i]), Ledger::Arrival::kAccepted);
      }
    }
    EXPECT_FALSE(ledger_.TakeNext());
    EXPECT_EQ(ledger_.Add(parts_[order][(missing + 1) % parts_[order].size()]), Ledger::Arrival::kDuplicate);
    EXPECT_EQ(ledger_.Add(parts_[order][missing]), Ledger::Arrival::kCompleted);
    ExpectNext(static_cast<int64_t>(order));
  }
}

/// A lie in a part that contradicts another part, which came before it or comes after it.
TEST_P(LedgerOfWideStates, RefusesPartsThatContradictEachOtherAndTakesThemRightLater) {
  using Lie = std::function<void(OrderResult&)>;
  const std::vector<Lie> lies = {
      [](OrderResult& part) {
        part.episode.actions[0] = static_cast<int16_t>((part.episode.actions[0] + 1) % 9);
      },
      [](OrderResult& part) { part.episode.rewards[0] += 1; },
      [](OrderResult& part) { part.episode.next_masks[0] ^= 1; },
      [](OrderResult& part) { part.episode.states[1] += 1; },      // s
      [](OrderResult& part) { part.episode.states.back() += 1; },  // s'
      [](OrderResult& part) { part.episode.ending = Ending::kTerminal; },
      [](OrderResult& part) { part.episode.ending = Ending::kTruncated; },
      [](OrderResult& part) { part.seed += 1; },
  };
  const std::vector<OrderResult>& parts = parts_[0];
  for (size_t lie = 0; lie < lies.size(); ++lie) {
    for (const size_t place : {size_t{3}, size_t{4}, size_t{5}}) {  // the second transition's three parts
      for (const bool first : {false, true}) {
        OrderResult false_part = parts[place];
        lies[lie](false_part);
        Ledger ledger(world_);
        ledger.Write({.index = 0});
        bool refused = first && ledger.Add(false_part) == Ledger::Arrival::kInconsistent;
        for (size_t i = 0; i < parts.size() && !refused; ++i) {
          if (i != place) {
            refused = ledger.Add(parts[i]) == Ledger::Arrival::kInconsistent;
          }
        }
        refused = refused || ledger.Add(false_part) == Ledger::Arrival::kInconsistent;
        EXPECT_TRUE(refused) << "lie " << lie << " in part " << place << (first ? ", at first" : ", at last");
        EXPECT_FALSE(ledger.TakeNext());
        for (const OrderResult& part : parts) {
          EXPECT_NE(ledger.Add(part), Ledger::Arrival::kInconsistent);
        }
        const auto committed = ledger.TakeNext();
        ASSERT_TRUE(committed.has_value());
        EXPECT_TRUE(SameBits(committed->episode, results_[0].episode));
      }
    }
  }
}

TEST_P(LedgerOfWideStates, RefusesTwoEnds) {
  ledger_.Add(parts_[0].back());
  OrderResult beyond = parts_[0].back();
  ++beyond.first_transition;
  EXPECT_EQ(ledger_.Add(beyond), Ledger::Arrival::kInconsistent);
  ExpectToTakeTheFirstOrder();
}

TEST_P(LedgerOfWideStates, RefusesAnEndBeforeWhatIsThere) {
  ledger_.Add(parts_[0].back());
  OrderResult earlier = parts_[0][0];
  earlier.episode.ending = Ending::kTerminal;
  EXPECT_EQ(ledger_.Add(earlier), Ledger::Arrival::kInconsistent);
  ExpectToTakeTheFirstOrder();
}

/// What only another flight could tell: a repeatable world has it told, any other believes its actor.
TEST_P(LedgerOfWideStates, FliesAgainOnlyWhatCanBeFlownAgain) {
  const std::vector<std::function<void(Episode&)>> lies = {
      [](Episode& episode) { episode.rewards[2] += 1; },
      [](Episode& episode) { episode.states[kFields + 7] += 1; },
      [](Episode& episode) { episode.next_masks[3] ^= 2; },
      [](Episode& episode) {
        episode.ending = episode.ending == Ending::kTerminal ? Ending::kTruncated : Ending::kTerminal;
      },
  };
  for (const auto& lie : lies) {
    OrderResult told = results_[0];
    lie(told.episode);
    Ledger ledger(world_);
    ledger.Write({.index = 0});
    Ledger::Arrival last = Ledger::Arrival::kDuplicate;
    SplitResult(world_, told, 7, [&](const transitions_t& message) {
      OrderResult part;
      ASSERT_TRUE(FromWire(world_, message, part));
      last = ledger.Add(part);
    });
    EXPECT_EQ(last, GetParam() ? Ledger::Arrival::kInconsistent : Ledger::Arrival::kCompleted);
    const auto committed = ledger.TakeNext();
    ASSERT_EQ(committed.has_value(), !GetParam());
    EXPECT_TRUE(!committed || SameBits(committed->episode, told.episode));
  }
}

TEST_P(LedgerOfWideStates, TakesNoInterestInErrors) {
  for (OrderResult part : parts_[0]) {
    ledger_.Add(part);
    part.td_errors[0] += 1;
    EXPECT_EQ(ledger_.Add(part), Ledger::Arrival::kDuplicate);
  }
  ExpectNext(0);
}

INSTANTIATE_TEST_SUITE_P(Worlds, LedgerOfWideStates, ::testing::Bool(), [](const auto& instance) {
  return instance.param ? "Repeatable" : "NotRepeatable";
});

}  // namespace
}  // namespace fresco
