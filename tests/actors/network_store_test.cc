#include "actors/network_store.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/actors/store_samples.h"

namespace fresco {
namespace {

constexpr NetworkVersion kTarget7{NetworkKind::kTarget, 7};

TEST(NetworkStore, CompletesAVersionFromChunksInAnyOrder) {
  RandomStream stream(1, RandomPurpose::kTest, 0, 0);
  for (int trial = 0; trial < 20; ++trial) {
    auto chunks = ChunksOf(7, kParameters);
    ASSERT_EQ(chunks.size(), static_cast<size_t>(kChunks));
    for (size_t i = chunks.size(); i > 1; --i) {
      std::swap(chunks[i - 1], chunks[stream.NextBelow(static_cast<uint32_t>(i))]);
    }
    NetworkStore store(kParameters);
    for (size_t i = 0; i < chunks.size(); ++i) {
      EXPECT_EQ(store.Find(kCurrent7), nullptr);
      EXPECT_TRUE(store.HeldVersions().empty());
      const bool last = i + 1 == chunks.size();
      EXPECT_EQ(store.Add(NetworkKind::kCurrent, chunks[i], 0),
                last ? Arrival::kCompleted : Arrival::kAccepted);
    }
    EXPECT_TRUE(Holds(store, kCurrent7, kParameters));
  }
}

TEST(NetworkStore, SaysWhatIsADuplicateBeforeAndAfterCompletion) {
  NetworkStore store(kParameters);
  for (const weights_t& chunk : ChunksOf(7, kParameters)) {
    store.Add(NetworkKind::kCurrent, chunk, 0);
    EXPECT_EQ(store.Add(NetworkKind::kCurrent, chunk, 0), Arrival::kDuplicate);
  }
  weights_t other = ChunksOf(7, kParameters)[3];
  other.values[5] += 1;
  EXPECT_EQ(store.Add(NetworkKind::kCurrent, other, 0), Arrival::kDuplicate);
  EXPECT_TRUE(Holds(store, kCurrent7, kParameters));
}

TEST(NetworkStore, KeepsTheTwoNetworksAndTheirVersionsApart) {
  NetworkStore store(kParameters);
  const auto chunks = ChunksOf(7, kParameters);
  const auto others = ChunksOf(8, kParameters);
  for (int i = 0; i < kChunks; ++i) {
    const auto chunk = static_cast<size_t>(i);
    store.Add(i % 2 == 0 ? NetworkKind::kCurrent : NetworkKind::kTarget, chunks[chunk], 0);
    store.Add(i % 2 == 0 ? NetworkKind::kTarget : NetworkKind::kCurrent, others[chunk], 0);
  }
  EXPECT_TRUE(store.HeldVersions().empty());
  Complete(store, {NetworkKind::kTarget, 8}, kParameters);
  EXPECT_TRUE(Holds(store, {NetworkKind::kTarget, 8}, kParameters));
  EXPECT_EQ(store.Find({NetworkKind::kCurrent, 8}), nullptr);
  EXPECT_EQ(store.Find(kTarget7), nullptr);
}

TEST(NetworkStore, RejectsAVersionWhoseCrcDoesNotHoldAndAsksForAllOfIt) {
  NetworkStore store(kParameters);
  store.SetWanted({kCurrent7});
  auto chunks = ChunksOf(7, kParameters);
  chunks[4].values[17] += 0.5f;
  for (const weights_t& chunk : chunks) {
    EXPECT_EQ(store.Add(NetworkKind::kCurrent, chunk, 0),
              chunk.offset == chunks.back().offset ? Arrival::kRejected : Arrival::kAccepted);
  }
  EXPECT_EQ(store.Find(kCurrent7), nullptr);
  EXPECT_TRUE(store.HeldVersions().empty());
  store.MissingRanges(0);
  EXPECT_EQ(Plain(store.MissingRanges(kQuietVersionUs)), (Ranges{{0, 7, 0, kChunks}}));
  Complete(store, kCurrent7, kParameters);
  EXPECT_TRUE(Holds(store, kCurrent7, kParameters));
}

TEST(NetworkStore, BeginsAnIncompleteVersionAnewWithAChunkOfAnotherCrc) {
  NetworkStore store(kParameters);
  weights_t lie = ChunksOf(7, kParameters)[1];
  lie.crc32c ^= 1;
  lie.values[0] += 1;
  EXPECT_EQ(store.Add(NetworkKind::kCurrent, lie, 0), Arrival::kAccepted);
  const auto chunks = ChunksOf(7, kParameters);
  EXPECT_EQ(store.Add(NetworkKind::kCurrent, chunks[0], 0), Arrival::kRestarted);
  EXPECT_EQ(store.MissingChunks(kCurrent7), kChunks - 1);
  Complete(store, kCurrent7, kParameters);
  EXPECT_TRUE(Holds(store, kCurrent7, kParameters));
}

TEST(NetworkStore, KeepsACompleteVersionAgainstChunksOfAnotherCrc) {
  NetworkStore store(kParameters);
  Complete(store, kCurrent7, kParameters);
  weights_t lie = ChunksOf(7, kParameters)[1];
  lie.crc32c ^= 1;
  EXPECT_EQ(store.Add(NetworkKind::kCurrent, lie, 0), Arrival::kRejected);
  EXPECT_TRUE(Holds(store, kCurrent7, kParameters));
  EXPECT_EQ(store.MissingChunks(kCurrent7), 0);
}

TEST(NetworkStore, MeasuresTheLongestTimeFromAFirstChunkToCompletion) {
  NetworkStore store(kParameters);
  EXPECT_EQ(store.longest_assembly_us(), 0);
  const auto chunks = ChunksOf(7, kParameters);
  for (size_t chunk = 0; chunk < chunks.size(); ++chunk) {
    store.Add(NetworkKind::kCurrent, chunks[chunk], 5000 + 100 * static_cast<int64_t>(chunk));
  }
  EXPECT_EQ(store.longest_assembly_us(), 900);
  Complete(store, {NetworkKind::kCurrent, 8}, kParameters, 50'000);  // all at once
  store.Add(NetworkKind::kCurrent, ChunksOf(9, kParameters)[0], 0);  // never complete
  EXPECT_EQ(store.longest_assembly_us(), 900);
  EXPECT_EQ(store.completed_versions(), 2);
}

TEST(NetworkStore, HandsOutParametersThatOutliveTheirVersion) {
  NetworkStore store(kParameters);
  Complete(store, kCurrent7, kParameters);
  const auto parameters = store.Find(kCurrent7);
  for (int32_t version = 8; version < 40; ++version) {
    Complete(store, {NetworkKind::kCurrent, version}, kParameters);
  }
  ASSERT_EQ(store.Find(kCurrent7), nullptr);
  EXPECT_EQ(parameters->size(), kParameters);
  EXPECT_EQ((*parameters)(2999), ValuesOf(7, kParameters)[2999]);
}

TEST(NetworkStore, HoldsNetworksOfASingleChunk) {
  for (const int64_t parameters : {int64_t{1}, int64_t{kValuesPerChunk}}) {
    NetworkStore store(parameters);
    EXPECT_EQ(store.Add(NetworkKind::kTarget, ChunksOf(7, parameters)[0], 0), Arrival::kCompleted);
    EXPECT_TRUE(Holds(store, kTarget7, parameters));
  }
}

}  // namespace
}  // namespace fresco
