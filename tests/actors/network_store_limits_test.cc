// What a network store refuses, asks for, forgets and reports.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "tests/actors/store_samples.h"

namespace fresco {
namespace {

constexpr int kLarge = 100 * kValuesPerChunk;  // values in a hundred chunks
constexpr NetworkVersion kTarget2{NetworkKind::kTarget, 2};

TEST(NetworkStore, RejectsSizesAndOffsetsThatAreNotThoseOfAChunk) {
  constexpr int kLargest = std::numeric_limits<int32_t>::max();
  constexpr int kSmallest = std::numeric_limits<int32_t>::min();
  const std::vector<std::function<void(weights_t&)>> lies = {
      [](weights_t& chunk) { chunk.total_values += 1; },
      [](weights_t& chunk) { chunk.total_values = kLargest; },
      [](weights_t& chunk) { chunk.total_values = 0; },
      [](weights_t& chunk) { chunk.offset += 1; },
      [](weights_t& chunk) { chunk.offset = -kValuesPerChunk; },
      [](weights_t& chunk) { chunk.offset = kSmallest; },
      [](weights_t& chunk) { chunk.offset = kChunks * kValuesPerChunk; },
      [](weights_t& chunk) { chunk.offset = (kChunks - 1) * kValuesPerChunk; },  // where it is too long
      [](weights_t& chunk) { chunk.offset = kLargest / kValuesPerChunk * kValuesPerChunk; },
      [](weights_t& chunk) { chunk.values.resize(static_cast<size_t>(--chunk.value_count)); },
      [](weights_t& chunk) { chunk.value_count = 0, chunk.values.clear(); },
      [](weights_t& chunk) { chunk.version = -1; },
      [](weights_t& chunk) { chunk.version = kSmallest; },
  };
  NetworkStore store(kParameters);
  store.SetWanted({kCurrent7});
  for (size_t i = 0; i < lies.size(); ++i) {
    weights_t chunk = ChunksOf(7, kParameters)[2];
    lies[i](chunk);
    EXPECT_EQ(store.Add(NetworkKind::kCurrent, chunk, 0), Arrival::kRejected) << i;
  }
  store.MissingRanges(0);
  EXPECT_EQ(Plain(store.MissingRanges(kQuietVersionUs)), (Ranges{{0, 7, 0, kChunks}}));
}

TEST(NetworkStore, ReportsExactlyTheGapsAndOnlyAfterQuietTime) {
  NetworkStore store(kParameters);
  store.SetWanted({kCurrent7});
  const auto chunks = ChunksOf(7, kParameters);
  for (const size_t chunk : {1u, 2u, 5u, 8u}) {
    store.Add(NetworkKind::kCurrent, chunks[chunk], 1000);
  }
  EXPECT_TRUE(store.MissingRanges(1000 + kQuietVersionUs - 1).empty());
  EXPECT_EQ(Plain(store.MissingRanges(1000 + kQuietVersionUs)),
            (Ranges{{0, 7, 0, 1}, {0, 7, 3, 2}, {0, 7, 6, 2}, {0, 7, 9, 1}}));
  store.Add(NetworkKind::kCurrent, chunks[4], 9000);
  EXPECT_TRUE(store.MissingRanges(9000 + kQuietVersionUs - 1).empty());  // they are still coming
  EXPECT_EQ(Plain(store.MissingRanges(9000 + kQuietVersionUs)),
            (Ranges{{0, 7, 0, 1}, {0, 7, 3, 1}, {0, 7, 6, 2}, {0, 7, 9, 1}}));
  Complete(store, kCurrent7, kParameters, 9000);
  EXPECT_TRUE(store.MissingRanges(100'000).empty());
}

TEST(NetworkStore, AsksForAllOfAVersionOfWhichNothingCameSinceItWasWanted) {
  NetworkStore store(kParameters);
  EXPECT_TRUE(store.MissingRanges(0).empty());
  store.SetWanted({kCurrent7, kTarget2});
  EXPECT_TRUE(store.MissingRanges(10'000).empty());
  EXPECT_TRUE(store.MissingRanges(10'000 + kQuietVersionUs - 1).empty());
  EXPECT_EQ(Plain(store.MissingRanges(10'000 + kQuietVersionUs)),
            (Ranges{{0, 7, 0, kChunks}, {1, 2, 0, kChunks}}));
  store.SetWanted({kTarget2});
  EXPECT_EQ(Plain(store.MissingRanges(20'000)), (Ranges{{1, 2, 0, kChunks}}));
  store.SetWanted({kCurrent7});  // wanted again: quiet time begins again
  EXPECT_TRUE(store.MissingRanges(30'000).empty());
}

TEST(NetworkStore, AsksForTheRestOfAVersionThatIsOnItsWayBeforeAnOrderNamesIt) {
  NetworkStore store(kParameters);
  store.Add(NetworkKind::kCurrent, ChunksOf(7, kParameters)[0], 1000);
  EXPECT_TRUE(store.MissingRanges(1000 + kQuietVersionUs - 1).empty());
  const Ranges rest = {{0, 7, 1, kChunks - 1}};
  EXPECT_EQ(Plain(store.MissingRanges(1000 + kQuietVersionUs)), rest);
  EXPECT_EQ(Plain(store.MissingRanges(1000 + 499'999)), rest);
  EXPECT_TRUE(store.MissingRanges(1000 + 500'000).empty());  // the learner has dropped it
  store.SetWanted({kCurrent7});
  EXPECT_EQ(Plain(store.MissingRanges(1000 + 500'000)), rest);
}

TEST(NetworkStore, AsksForNoVersionThatIsOlderThanTheOnesWantedOfLate) {
  NetworkStore store(kParameters);
  store.SetWanted({kCurrent7, {NetworkKind::kCurrent, 9}});
  store.SetWanted({});
  for (const int32_t version : {6, 7, 8}) {
    store.Add(NetworkKind::kCurrent, ChunksOf(version, kParameters)[0], 0);
  }
  store.Add(NetworkKind::kTarget, ChunksOf(2, kParameters)[0], 0);  // of targets none was wanted
  EXPECT_EQ(Plain(store.MissingRanges(kQuietVersionUs)),
            (Ranges{{0, 7, 1, kChunks - 1}, {0, 8, 1, kChunks - 1}, {1, 2, 1, kChunks - 1}}));
}

TEST(NetworkStore, AsksFirstForWhatOrdersName) {
  NetworkStore store(kLarge);
  const auto chunks = ChunksOf(7, kLarge);
  for (size_t chunk = 0; chunk < chunks.size(); chunk += 2) {
    store.Add(NetworkKind::kCurrent, chunks[chunk], 0);
  }
  store.SetWanted({kTarget2});
  store.MissingRanges(0);
  const Ranges ranges = Plain(store.MissingRanges(kQuietVersionUs));
  EXPECT_EQ(ranges.size(), static_cast<size_t>(kMaximumMissingRanges));
  EXPECT_EQ(ranges.front(), std::tuple(1, 2, 0, kLarge / kValuesPerChunk));
}

TEST(NetworkStore, IsNotCrowdedByVersionNumbersThatAreLies) {
  NetworkStore store(kParameters);
  constexpr int32_t kLargest = std::numeric_limits<int32_t>::max();
  for (int32_t lie = 0; lie < 1000; ++lie) {
    store.Add(NetworkKind::kCurrent, ChunksOf(kLargest - lie, kParameters)[0], lie);
  }
  Complete(store, kCurrent7, kParameters, 2000);
  Complete(store, {NetworkKind::kCurrent, 8}, kParameters, 3000);
  EXPECT_TRUE(Holds(store, kCurrent7, kParameters));
  EXPECT_LE(store.MissingRanges(100'000).size(), 7u);
}

TEST(NetworkStore, ForgetsAllThatWasWantedOnceRoomIsNeeded) {
  NetworkStore store(kParameters);
  std::set<NetworkVersion> wanted;
  for (int32_t version = 0; version < 30; ++version) {
    wanted.insert({NetworkKind::kCurrent, version});
  }
  store.SetWanted(wanted);
  for (const NetworkVersion& version : wanted) {
    Complete(store, version, kParameters);
  }
  EXPECT_EQ(store.HeldVersions().size(), 30u);
  store.SetWanted({});
  Complete(store, {NetworkKind::kCurrent, 30}, kParameters, 1);
  EXPECT_EQ(store.HeldVersions().size(), 8u);
  EXPECT_TRUE(Holds(store, {NetworkKind::kCurrent, 30}, kParameters));
}

TEST(NetworkStore, ReportsAtMostAsManyRangesAsAMessageTakes) {
  NetworkStore store(kLarge);
  std::set<NetworkVersion> wanted = {kCurrent7};
  for (int32_t version = 100; version < 200; ++version) {
    wanted.insert({NetworkKind::kTarget, version});
  }
  store.SetWanted(wanted);
  const auto chunks = ChunksOf(7, kLarge);
  for (size_t chunk = 0; chunk < chunks.size(); chunk += 2) {
    store.Add(NetworkKind::kCurrent, chunks[chunk], 0);
  }
  store.MissingRanges(0);
  const Ranges ranges = Plain(store.MissingRanges(kQuietVersionUs));
  ASSERT_EQ(ranges.size(), static_cast<size_t>(kMaximumMissingRanges));
  for (int i = 0; i < kMaximumMissingRanges; ++i) {
    EXPECT_EQ(ranges[static_cast<size_t>(i)], std::tuple(0, 7, 2 * i + 1, 1));
  }
}

TEST(NetworkStore, BoundsWhatItKeepsOfHundredsOfVersionsAndKeepsTheWantedOnes) {
  NetworkStore store(kParameters);
  store.SetWanted({kCurrent7, kTarget2});
  Complete(store, kCurrent7, kParameters);
  store.Add(NetworkKind::kTarget, ChunksOf(2, kParameters)[0], 0);
  constexpr int32_t kVersions = 400;
  for (int32_t version = 8; version < kVersions; ++version) {
    Complete(store, {NetworkKind::kCurrent, version}, kParameters);
    store.Add(NetworkKind::kTarget, ChunksOf(version, kParameters)[0], 0);  // for ever incomplete
  }
  int kept = 0;
  for (int32_t version = 8; version < kVersions; ++version) {
    kept += store.Find({NetworkKind::kCurrent, version}) != nullptr;
  }
  EXPECT_GE(kept, 1);
  EXPECT_LE(kept, 16);
  EXPECT_TRUE(Holds(store, kCurrent7, kParameters));
  EXPECT_EQ(Plain(store.MissingRanges(1'000'000)), (Ranges{{1, 2, 1, kChunks - 1}}));
}

TEST(NetworkStore, ReportsTheVersionsItHoldsTheNewestOfEachNetworkFirst) {
  NetworkStore store(kParameters);
  EXPECT_TRUE(store.HeldVersions().empty());
  for (const int32_t version : {3, 1, 2}) {
    Complete(store, {NetworkKind::kCurrent, version}, kParameters);
  }
  Complete(store, kTarget2, kParameters);
  store.Add(NetworkKind::kTarget, ChunksOf(3, kParameters)[0], 0);  // incomplete
  EXPECT_EQ(Plain(store.HeldVersions()),
            (Ranges{{1, 2, 0, kChunks}, {0, 3, 0, kChunks}, {0, 2, 0, kChunks}, {0, 1, 0, kChunks}}));
}

TEST(NetworkStore, ReportsAtMostAsManyVersionsAsAMessageTakes) {
  NetworkStore store(1);
  std::set<NetworkVersion> wanted;
  for (int32_t version = 0; version < 2 * kMaximumHeldVersions; ++version) {
    wanted.insert({NetworkKind::kCurrent, version});
  }
  store.SetWanted(wanted);
  for (const NetworkVersion& version : wanted) {
    Complete(store, version, 1);
  }
  EXPECT_EQ(store.HeldVersions().size(), static_cast<size_t>(kMaximumHeldVersions));
  EXPECT_EQ(store.HeldVersions().front().version, 2 * kMaximumHeldVersions - 1);
}

}  // namespace
}  // namespace fresco
