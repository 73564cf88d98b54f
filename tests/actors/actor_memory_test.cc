// What is foretold of an actor's memory, against what its parts really take of the heap.
#include "actors/served_run.h"

#include <gtest/gtest.h>

#include "tests/actors/store_samples.h"
#include "tests/support/heap_use.h"
#include "tests/training/acting_samples.h"

namespace fresco {
namespace {

using ActorMemoryTest = HeapUseTest;

TEST_F(ActorMemoryTest, OfEnvironmentsInFlightIsForetoldAtMost) {
  constexpr int kEnvironments = 200;
  const Experiment experiment = SmallField({{"scenario.slots", "60"},
                                            {"scenario.initial_energy_j", "22000"},
                                            {"agent.safe_action_mask", "true"},
                                            {"agent.sensor_geometry", "true"}});
  const SharedParameters network = SampleNetwork(experiment, 1);
  const int64_t measured = HeapUseOf([&] {
    auto flyer = std::make_unique<Flyer>(experiment, kEnvironments);
    for (int64_t index = 0; index < kEnvironments; ++index) {
      flyer->Start(TrainOrder(index, 1), network, network);
    }
    for (int slot = 1; slot < 59; ++slot) {  // one short of the end
      flyer->Step([](const Order&, const OrderResult&) {});
    }
    EXPECT_EQ(flyer->open_flights(), kEnvironments);
    return flyer;
  });
  const int64_t foretold = Flyer::BytesFor(experiment, kEnvironments, kEnvironments);
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
