// What the tests of the weight publisher share: versions of 1,000 values in four chunks.
#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include "core/random.h"
#include "learner/weight_publisher.h"

namespace fresco {

inline constexpr int kValues = 1000;  // 308 + 308 + 308 + 76
inline constexpr int kChunks = 4;
inline constexpr int64_t kNowUs = 1'000'000;
inline constexpr int32_t kIntMax = std::numeric_limits<int32_t>::max();
inline constexpr int32_t kIntMin = std::numeric_limits<int32_t>::min();

using Sent = std::vector<std::tuple<NetworkKind, int32_t, int>>;  // which network, version, chunk

inline std::shared_ptr<const Vector> ParametersOf(uint32_t version, int values = kValues) {
  RandomStream stream(1, RandomPurpose::kTest, version, 0);
  Vector parameters(values);
  for (float& value : parameters) {
    value = static_cast<float>(stream.NextUniform() - 0.5);
  }
  return std::make_shared<const Vector>(parameters);
}

/// Everything that is due at `now_us`.
inline Sent Drain(WeightPublisher& publisher, int64_t now_us) {
  Sent sent;
  constexpr size_t kEndless = 1000;
  while (const auto next = sent.size() < kEndless ? publisher.Next(now_us) : std::nullopt) {
    sent.emplace_back(next->first, next->second.version, ChunkIndex(next->second, kValues));
  }
  return sent;
}

/// The same by chunk: the order of what is sent again is free.
inline Sent DrainSorted(WeightPublisher& publisher, int64_t now_us) {
  Sent sent = Drain(publisher, now_us);
  std::sort(sent.begin(), sent.end());
  return sent;
}

inline Sent ChunksOf(NetworkKind kind, int32_t version, int first = 0, int end = kChunks) {
  Sent chunks;
  for (int chunk = first; chunk < end; ++chunk) {
    chunks.emplace_back(kind, version, chunk);
  }
  return chunks;
}

inline chunk_range_t Range(NetworkKind kind, int32_t version, int32_t first, int32_t count) {
  return ChunkRange({kind, version}, first, count);
}

/// All chunks of a version of the current network.
inline chunk_range_t AllOf(int32_t version) {
  return Range(NetworkKind::kCurrent, version, 0, kChunks);
}

}  // namespace fresco
