// What the tests of the network store share: chunks of versions of random values.
#pragma once

#include <tuple>
#include <vector>

#include "actors/network_store.h"
#include "core/bytes.h"
#include "tests/nn/literal_network.h"

namespace fresco {

using Arrival = NetworkStore::Arrival;

inline constexpr int64_t kParameters = 3000;  // nine chunks of 308 values, one of 228
inline constexpr int kChunks = 10;
inline constexpr NetworkVersion kCurrent7{NetworkKind::kCurrent, 7};

inline std::vector<float> ValuesOf(int32_t version, int64_t count) {
  RandomStream stream(2026, RandomPurpose::kTest, 2, static_cast<uint32_t>(version));
  return RandomFloats(stream, static_cast<size_t>(count), 1);
}

inline std::vector<weights_t> ChunksOf(int32_t version, int64_t count) {
  const std::vector<float> values = ValuesOf(version, count);
  std::vector<weights_t> chunks;
  for (int chunk = 0; chunk < ChunkCount(count); ++chunk) {
    chunks.push_back(WeightsChunk(values, Crc32c(values), version, chunk));
  }
  return chunks;
}

/// Adds every chunk of a version.
inline void Complete(NetworkStore& store, NetworkVersion version, int64_t count, int64_t now_us = 0) {
  for (const weights_t& chunk : ChunksOf(version.number, count)) {
    store.Add(version.kind, chunk, now_us);
  }
}

inline bool Holds(const NetworkStore& store, NetworkVersion version, int64_t count) {
  const auto parameters = store.Find(version);
  const std::vector<float> values = ValuesOf(version.number, count);
  return parameters != nullptr && std::equal(values.begin(), values.end(), parameters->data(),
                                             parameters->data() + parameters->size());
}

/// network, version, first, count.
using Ranges = std::vector<std::tuple<int, int, int, int>>;

inline Ranges Plain(const std::vector<chunk_range_t>& ranges) {
  Ranges plain;
  for (const chunk_range_t& range : ranges) {
    plain.emplace_back(range.network, range.version, range.first, range.count);
  }
  return plain;
}

}  // namespace fresco
