#include "msgs/weights_codec.h"

#include <algorithm>

#include "core/error.h"

namespace fresco {

const char* Name(NetworkKind kind) {
  return kind == NetworkKind::kCurrent ? "current" : "target";
}

std::array<NetworkVersion, 2> VersionsOf(const Order& order) {
  return {{{NetworkKind::kCurrent, order.current_version}, {NetworkKind::kTarget, order.target_version}}};
}

chunk_range_t ChunkRange(NetworkVersion version, int first, int count) {
  chunk_range_t range{};
  range.network = static_cast<int8_t>(version.kind);
  range.version = version.number;
  range.first = first;
  range.count = count;
  return range;
}

NetworkVersion VersionOf(const chunk_range_t& range) {
  return {static_cast<NetworkKind>(range.network), range.version};
}

int ChunkCount(int64_t parameters) {
  return static_cast<int>((parameters + kValuesPerChunk - 1) / kValuesPerChunk);
}

weights_t WeightsChunk(std::span<const float> values, uint32_t crc32c, int32_t version, int chunk) {
  const size_t offset = static_cast<size_t>(chunk) * kValuesPerChunk;
  FRESCO_CHECK(chunk >= 0 && offset < values.size());
  const auto part = values.subspan(offset, std::min<size_t>(kValuesPerChunk, values.size() - offset));
  weights_t message{};
  message.value_count = static_cast<int32_t>(part.size());
  message.version = version;
  message.offset = static_cast<int32_t>(offset);
  message.total_values = static_cast<int32_t>(values.size());
  message.crc32c = crc32c;
  message.values.assign(part.begin(), part.end());
  return message;
}

int ChunkIndex(const weights_t& message, int64_t parameters) {
  if (message.total_values != parameters || message.version < 0 || message.offset < 0 ||
      message.offset % kValuesPerChunk != 0 || message.offset >= parameters ||
      message.value_count != std::min<int64_t>(kValuesPerChunk, parameters - message.offset)) {
    return -1;
  }
  return message.offset / kValuesPerChunk;
}

}  // namespace fresco
