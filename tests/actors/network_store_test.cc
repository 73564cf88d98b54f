#include "actors/network_store.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/actors/store_samples.h"

namespace fresco {
namespace {

using Arrival = NetworkStore::Arrival;

constexpr int64_t kStoredParameters = 3000;  // nine chunks of 308 values, one of 228
constexpr int kStoredChunks = 10;
constexpr NetworkVersion kStoredCurrent7{NetworkKind::kCurrent, 7};
constexpr NetworkVersion kTarget7{NetworkKind::kTarget, 7};

TEST(NetworkStore, CompletesAVersionFromChunksInAnyOrder) {
  RandomStream stream(1, RandomPurpose::kTest, 0, 0);
  for (int trial = 0; trial < 20; ++trial) {
    auto chunks = ChunksOf(7, kStoredParameters);
    ASSERT_EQ(chunks.size(), static_cast<size_t>(kStoredChunks));
    for (size_t i = chunks.size(); i > 1; --i) {
      std::swap(chunks[i - 1], chunks[stream.NextBelow(static_cast<uint32_t>(i))]);
    }
    NetworkStore store(kStoredParameters);
    for (size_t i = 0; i < chunks.size(); ++i) {
      EXPECT_EQ(store.Find(kStoredCurrent7), nullptr);
      EXPECT_TRUE(store.HeldVersions().empty());
      const bool last = i + 1 == chunks.size();
      EXPECT_EQ(store.Add(NetworkKind::kCurrent, chunks[i], 0),
                last ? Arrival::kCompleted : Arrival::kAccepted);
    }
    EXPECT_TRUE(Holds(store, kStoredCurrent7, kStoredParameters));
  }
}

TEST(NetworkStore, SaysWhatIsADuplicateBeforeAndAfterCompletion) {
  NetworkStore store(kStoredParameters);
  for (const weights_t& chunk : ChunksOf(7, kStoredParameters)) {
    store.Add(NetworkKind::kCurrent, chunk, 0);
    EXPECT_EQ(store.Add(NetworkKind::kCurrent, chunk, 0), Arrival::kDuplicate);
  }
  weights_t other = ChunksOf(7, kStoredParameters)[3];
  other.values[5] += 1;
  EXPECT_EQ(store.Add(NetworkKind::kCurrent, other, 0), Arrival::kDuplicate);
  EXPECT_TRUE(Holds(store, kStoredCurrent7, kStoredParameters));
}

TEST(NetworkStore, KeepsTheTwoNetworksAndTheirVersionsApart) {
  NetworkStore store(kStoredParameters);
  const auto chunks = ChunksOf(7, kStoredParameters);
  const auto others = ChunksOf(8, kStoredParameters);
  for (int i = 0; i < kStoredChunks; ++i) {
    const auto chunk = static_cast<size_t>(i);
    store.Add(i % 2 == 0 ? NetworkKind::kCurrent : NetworkKind::kTarget, chunks[chunk], 0);
    store.Add(i % 2 == 0 ? NetworkKind::kTarget : NetworkKind::kCurrent, others[chunk], 0);
  }
  EXPECT_TRUE(store.HeldVersions().empty());
  Complete(store, {NetworkKind::kTarget, 8}, kStoredParameters);
  EXPECT_TRUE(Holds(store, {NetworkKind::kTarget, 8}, kStoredParameters));
  EXPECT_EQ(store.Find({NetworkKind::kCurrent, 8}), nullptr);
  EXPECT_EQ(store.Find(kTarget7), nullptr);
}

TEST(NetworkStore, RejectsAVersionWhoseCrcDoesNotHoldAndAsksForAllOfIt) {
  NetworkStore store(kStoredParameters);
  store.SetWanted({kStoredCurrent7});
  auto chunks = ChunksOf(7, kStoredParameters);
  chunks[4].values[17] += 0.5f;
  for (const weights_t& chunk : chunks) {
    EXPECT_EQ(store.Add(NetworkKind::kCurrent, chunk, 0),
              chunk.offset == chunks.back().offset ? Arrival::kRejected : Arrival::kAccepted);
  }
  EXPECT_EQ(store.Find(kStoredCurrent7), nullptr);
  EXPECT_TRUE(store.HeldVersions().empty());
  store.MissingRanges(0);
  EXPECT_EQ(Plain(store.MissingRanges(kQuietUs)), (Ranges{{0, 7, 0, kStoredChunks}}));
  Complete(store, kStoredCurrent7, kStoredParameters);
  EXPECT_TRUE(Holds(store, kStoredCurrent7, kStoredParameters));
}

TEST(NetworkStore, BeginsAnIncompleteVersionAnewWithAChunkOfAnotherCrc) {
  NetworkStore store(kStoredParameters);
  weights_t lie = ChunksOf(7, kStoredParameters)[1];
  lie.crc32c ^= 1;
  lie.values[0] += 1;
  EXPECT_EQ(store.Add(NetworkKind::kCurrent, lie, 0), Arrival::kAccepted);
  const auto chunks = ChunksOf(7, kStoredParameters);
  EXPECT_EQ(store.Add(NetworkKind::kCurrent, chunks[0], 0), Arrival::kRestarted);
  EXPECT_EQ(store.MissingChunks(kStoredCurrent7), kStoredChunks - 1);
  Complete(store, kStoredCurrent7, kStoredParameters);
  EXPECT_TRUE(Holds(store, kStoredCurrent7, kStoredParameters));
}

TEST(NetworkStore, KeepsACompleteVersionAgainstChunksOfAnotherCrc) {
  NetworkStore store(kStoredParameters);
  Complete(store, kStoredCurrent7, kStoredParameters);
  weights_t lie = ChunksOf(7, kStoredParameters)[1];
  lie.crc32c ^= 1;
  EXPECT_EQ(store.Add(NetworkKind::kCurrent, lie, 0), Arrival::kRejected);
  EXPECT_TRUE(Holds(store, kStoredCurrent7, kStoredParameters));
  EXPECT_EQ(store.MissingChunks(kStoredCurrent7), 0);
}

TEST(NetworkStore, MeasuresTheLongestTimeFromAFirstChunkToCompletion) {
  NetworkStore store(kStoredParameters);
  EXPECT_EQ(store.longest_assembly_us(), 0);
  const auto chunks = ChunksOf(7, kStoredParameters);
  for (size_t chunk = 0; chunk < chunks.size(); ++chunk) {
    store.Add(NetworkKind::kCurrent, chunks[chunk], 5000 + 100 * static_cast<int64_t>(chunk));
  }
  EXPECT_EQ(store.longest_assembly_us(), 900);
  Complete(store, {NetworkKind::kCurrent, 8}, kStoredParameters, 50'000);  // all at once
  store.Add(NetworkKind::kCurrent, ChunksOf(9, kStoredParameters)[0], 0);  // never complete
  EXPECT_EQ(store.longest_assembly_us(), 900);
  EXPECT_EQ(store.completed_versions(), 2);
}

TEST(NetworkStore, HandsOutParametersThatOutliveTheirVersion) {
  NetworkStore store(kStoredParameters);
  Complete(store, kStoredCurrent7, kStoredParameters);
  const auto parameters = store.Find(kStoredCurrent7);
  for (int32_t version = 8; version < 40; ++version) {
    Complete(store, {NetworkKind::kCurrent, version}, kStoredParameters);
  }
  ASSERT_EQ(store.Find(kStoredCurrent7), nullptr);
  EXPECT_EQ(parameters->size(), kStoredParameters);
  EXPECT_EQ((*parameters)(2999), ValuesOf(7, kStoredParameters)[2999]);
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
