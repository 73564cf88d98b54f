// The orders and the kept episodes of one run; what is foretold of an actor's memory, against what its parts
// really take of the heap.
#include "actors/served_run.h"

#include <gtest/gtest.h>

#include "msgs/protocol_times.h"
#include "tests/actors/store_samples.h"
#include "tests/support/heap_use.h"
#include "tests/support/sanitized.h"
#include "tests/training/acting_samples.h"

namespace fresco {
namespace {

/// A run with version 0 of both networks, whose orders are for actor 1.
class ServedRunTest : public ::testing::Test {
 protected:
  ServedRunTest() {
    Complete(run_.store(), {NetworkKind::kCurrent, 0}, parameters_);
    Complete(run_.store(), {NetworkKind::kTarget, 0}, parameters_);
  }

  /// Hands over these orders of a window that begins at `committed`; returns the contradictions.
  int Give(int64_t committed, const std::vector<int64_t>& indices, int64_t now_us) {
    orders_t message{};
    message.committed_orders = committed;
    for (const int64_t index : indices) {
      message.orders.push_back(ToWire(TrainOrder(index, 1), 1, 0));
    }
    return run_.HandleOrders(message, 1, now_us);
  }
  void FlyAll(int64_t now_us) {
    do {
      run_.Step(now_us);
    } while (!run_.Idle());
  }

  Experiment experiment_ = SmallField();
  int64_t parameters_ = experiment_.network_shape().parameter_count();
  std::vector<std::pair<int64_t, bool>> sent_;  // index, and whether again
  ServedRun run_{
      experiment_, RunIdentity{7, experiment_.hash()}, 4,
      [this](const OrderResult& result, bool again) { sent_.emplace_back(result.order_index, again); }};
};

TEST_F(ServedRunTest, SendsAKeptEpisodeAgainButNotTooSoon) {
  EXPECT_EQ(Give(0, {0}, 0), 0);
  FlyAll(1000);
  EXPECT_EQ(Give(0, {0}, 1000 + kResendPeriodUs - 1), 0);
  EXPECT_EQ(Give(0, {0}, 1000 + kResendPeriodUs), 0);
  EXPECT_EQ(Give(0, {0}, 1000 + kResendPeriodUs), 0);
  EXPECT_EQ(sent_, (std::vector<std::pair<int64_t, bool>>{{0, false}, {0, true}}));
}

TEST_F(ServedRunTest, FliesAnewWhatHasLeftTheWindow) {
  Give(0, {0, 1}, 0);
  FlyAll(0);
  Give(1, {}, 0);                    // order 0 is committed
  Give(0, {0, 1}, kResendPeriodUs);  // the learner was resumed
  FlyAll(kResendPeriodUs);
  EXPECT_EQ(sent_, (std::vector<std::pair<int64_t, bool>>{{0, false}, {1, false}, {1, true}, {0, false}}));
}

TEST_F(ServedRunTest, CountsWhatLiesBeyondTheWindow) {
  const int64_t end = 100 + MaximumOrdersInFlight(experiment_.schedule().window());
  EXPECT_EQ(Give(100, {99, end - 1}, 0), 0);  // one is done, which is no contradiction
  EXPECT_EQ(Give(100, {end, -1}, 0), 2);
  EXPECT_EQ(Give(-1, {}, 0), 1);
  EXPECT_EQ(Give((int64_t{1} << 32) + 1, {}, 0), 1);
}

TEST_F(ServedRunTest, IsDeafToWhatIsMuchOlderThanItsNewestMessage) {
  EXPECT_TRUE(run_.Hear(5 * kStaleUs, 10));
  EXPECT_TRUE(run_.Hear(4 * kStaleUs, 20));
  EXPECT_FALSE(run_.Hear(4 * kStaleUs - 1, 30));
  EXPECT_EQ(run_.last_heard_us(), 20);
  EXPECT_EQ(run_.newest_utime(), 5 * kStaleUs);
}

class ActorMemoryTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (kSanitized) {
      GTEST_SKIP() << "a sanitizer has a heap of its own";
    }
  }
};

TEST_F(ActorMemoryTest, OfEnvironmentsInFlightIsForetoldAtMost) {
  constexpr int kEnvironments = 200;
  const Experiment experiment = SmallField({{"scenario.slots", "60"},
                                            {"scenario.initial_energy_j", "22000"},
                                            {"agent.safe_action_mask", "true"},
                                            {"agent.sensor_geometry", "true"}});
  const World world(experiment.scenario());
  const SharedParameters network = SampleNetwork(experiment, 1);
  const int64_t measured = HeapUseOf([&] {
    auto flyer = std::make_unique<Flyer>(world, experiment, kEnvironments);
    for (int64_t index = 0; index < kEnvironments; ++index) {
      flyer->Start(TrainOrder(index, 1), network, network);
    }
    for (int slot = 1; slot < 59; ++slot) {  // one short of the end
      flyer->Step([](const Order&, OrderResult&) {});
    }
    EXPECT_EQ(flyer->open_flights(), kEnvironments);
    return flyer;
  });
  const int64_t foretold = Flyer::BytesFor(world, experiment, kEnvironments, kEnvironments);
  EXPECT_LE(measured, foretold);
  EXPECT_GE(measured, foretold / 2);  // a vector that grows has between once and twice the room that it needs
}

TEST_F(ActorMemoryTest, OfTheNetworksThatItHoldsIsForetold) {
  constexpr int64_t kManyParameters = 100'000;
  constexpr int32_t kWanted = 12;
  std::set<NetworkVersion> wanted;
  for (int32_t version = 0; version < kWanted; ++version) {
    wanted.insert({NetworkKind::kCurrent, version});
  }
  const int64_t measured = HeapUseOf([&] {
    auto store = std::make_unique<NetworkStore>(kManyParameters);
    store->SetWanted(wanted);
    for (int32_t version = 0; version < 3 * kWanted; ++version) {
      Complete(*store, {NetworkKind::kCurrent, version}, kManyParameters, version);
    }
    return store;
  });
  const auto foretold = static_cast<double>(NetworkStore::BytesFor(kManyParameters, kWanted));
  EXPECT_NEAR(static_cast<double>(measured), foretold, 0.05 * foretold);
}

TEST_F(ActorMemoryTest, OfAConfigurationGrowsWithEveryFieldThatSetsIt) {
  constexpr int kEnvironments = 16;
  const int64_t usual = ActorMemory(SmallField(), kEnvironments).bytes();
  for (const auto& [field, value] : Settings{
           {"agent.hidden_layers", "2000,2000"}, {"schedule.window", "4096"}, {"scenario.slots", "1000"}}) {
    const Experiment larger = SmallField({{field, value}, {"scenario.initial_energy_j", "1e6"}});
    EXPECT_GT(ActorMemory(larger, kEnvironments).bytes(), usual) << field;
  }
  EXPECT_GT(ActorMemory(SmallField(), 4096).bytes(), usual);
}

}  // namespace
}  // namespace fresco
