#include "learner/weight_publisher.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/bytes.h"
#include "msgs/protocol_times.h"

namespace fresco {

int64_t WeightPublisher::BytesPerVersion(int64_t parameters) {
  const auto of_chunk = static_cast<int64_t>(sizeof(decltype(Version::due)::value_type) +
                                             sizeof(decltype(Version::sent_us)::value_type));
  return static_cast<int64_t>(sizeof(Version)) + ChunkCount(parameters) * of_chunk;
}

void WeightPublisher::Offer(NetworkKind kind, int32_t version, std::shared_ptr<const Vector> parameters) {
  Version entry;
  const auto size = static_cast<size_t>(parameters->size());
  entry.crc32c = Crc32c(std::span<const float>(parameters->data(), size));
  entry.due_count = ChunkCount(parameters->size());
  entry.due.assign(static_cast<size_t>(entry.due_count), 1);
  entry.sent_us.assign(entry.due.size(), 0);
  entry.parameters = std::move(parameters);
  versions_[{version, kind}] = std::move(entry);
}

void WeightPublisher::Retain(int32_t oldest_current, int32_t oldest_target) {
  std::erase_if(versions_, [&](const auto& entry) {
    const auto& [version, kind] = entry.first;
    return version < (kind == NetworkKind::kCurrent ? oldest_current : oldest_target);
  });
}

void WeightPublisher::Request(const chunk_range_t& range, int64_t now_us) {
  const auto found = versions_.find({range.version, static_cast<NetworkKind>(range.network)});
  if (found == versions_.end() || range.first < 0 || range.count < 1) {
    return;
  }
  Version& version = found->second;
  const int64_t end =
      std::min<int64_t>(int64_t{range.first} + range.count, static_cast<int64_t>(version.due.size()));
  for (int64_t chunk = range.first; chunk < end; ++chunk) {
    const auto i = static_cast<size_t>(chunk);
    if (version.due[i] == 0 && now_us - version.sent_us[i] >= kChunkRepeatPeriodUs) {
      version.due[i] = 1;
      ++version.due_count;
    }
  }
}

std::optional<std::pair<NetworkKind, weights_t>> WeightPublisher::Next(int64_t now_us) {
  for (auto& [key, version] : versions_) {
    if (version.due_count == 0) {
      continue;
    }
    const int chunks = static_cast<int>(version.due.size());
    while (version.due[static_cast<size_t>(version.next)] == 0) {
      version.next = (version.next + 1) % chunks;
    }
    const auto chunk = static_cast<size_t>(version.next);
    version.due[chunk] = 0;
    --version.due_count;
    ++sent_chunks_;
    repeated_chunks_ += version.sent_us[chunk] != 0 ? 1 : 0;
    version.sent_us[chunk] = now_us;
    const std::span<const float> values(version.parameters->data(),
                                        static_cast<size_t>(version.parameters->size()));
    return std::pair(key.second, WeightsChunk(values, version.crc32c, key.first, version.next));
  }
  return std::nullopt;
}

std::string WeightPublisher::Offered() const {
  std::string text;
  for (const auto& [key, version] : versions_) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ",
                        key.second == NetworkKind::kCurrent ? "current" : "target", key.first);
    text += version.due_count > 0 ? fmt::format(" ({} chunks due)", version.due_count) : "";
  }
  return text.empty() ? "none" : text;
}

}  // namespace fresco
