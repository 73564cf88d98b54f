#include "learner/weight_publisher.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/bytes.h"
#include "msgs/protocol_times.h"

namespace fresco {

int64_t WeightPublisher::BytesPerVersion(int64_t parameters) {
  const auto of_chunk = static_cast<int64_t>(sizeof(decltype(Offered::due)::value_type) +
                                             sizeof(decltype(Offered::sent_us)::value_type));
  return static_cast<int64_t>(sizeof(Offered)) + ChunkCount(parameters) * of_chunk;
}

bool WeightPublisher::OlderFirst::operator()(NetworkVersion a, NetworkVersion b) const {
  return std::pair(a.number, a.kind) < std::pair(b.number, b.kind);
}

void WeightPublisher::Offer(NetworkVersion version, std::shared_ptr<const Vector> parameters) {
  Offered entry;
  entry.crc32c = Crc32c(Values(*parameters));
  entry.due_count = ChunkCount(parameters->size());
  entry.due.assign(static_cast<size_t>(entry.due_count), 1);
  entry.sent_us.assign(entry.due.size(), 0);
  entry.parameters = std::move(parameters);
  versions_[version] = std::move(entry);
}

void WeightPublisher::Retain(int32_t oldest_current, int32_t oldest_target) {
  std::erase_if(versions_, [&](const auto& entry) {
    const auto& [kind, number] = entry.first;
    return number < (kind == NetworkKind::kCurrent ? oldest_current : oldest_target);
  });
}

void WeightPublisher::Request(const chunk_range_t& range, int64_t now_us) {
  const auto found = versions_.find(VersionOf(range));
  if (found == versions_.end() || range.first < 0 || range.count < 1) {
    return;
  }
  Offered& version = found->second;
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
    return std::pair(key.kind,
                     WeightsChunk(Values(*version.parameters), version.crc32c, key.number, version.next));
  }
  return std::nullopt;
}

std::string WeightPublisher::StateText() const {
  std::string text;
  for (const auto& [key, version] : versions_) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", Name(key.kind), key.number);
    text += version.due_count > 0 ? fmt::format(" ({} chunks due)", version.due_count) : "";
  }
  return text.empty() ? "none" : text;
}

}  // namespace fresco
