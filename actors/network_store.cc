#include "actors/network_store.h"

#include <algorithm>

#include "core/crc32c.h"

namespace fresco {
namespace {

// Versions kept beyond the wanted ones: the newest, which the next orders will name.
constexpr size_t kSpareVersions = 8;

chunk_range_t Range(NetworkVersion version, int first, int count) {
  chunk_range_t range{};
  range.network = static_cast<int8_t>(version.first);
  range.version = version.second;
  range.first = first;
  range.count = count;
  return range;
}

}  // namespace

NetworkStore::Arrival NetworkStore::Add(NetworkKind kind, const weights_t& message, int64_t now_us) {
  const int chunk = ChunkIndex(message, parameters_);
  if (chunk < 0) {
    return Arrival::kRejected;
  }
  const NetworkVersion version{kind, message.version};
  Assembly& assembly = Open(version, message.crc32c, now_us);
  if (assembly.crc32c != message.crc32c) {
    return Arrival::kRejected;
  }
  assembly.last_arrival_us = now_us;
  if (assembly.received[static_cast<size_t>(chunk)] != 0) {
    return Arrival::kDuplicate;
  }
  std::copy(message.values.begin(), message.values.end(), assembly.values->data() + message.offset);
  assembly.received[static_cast<size_t>(chunk)] = 1;
  if (--assembly.missing_chunks > 0) {
    return Arrival::kAccepted;
  }
  const std::span<const float> values(assembly.values->data(), static_cast<size_t>(parameters_));
  if (Crc32c(values) != static_cast<uint32_t>(assembly.crc32c)) {
    versions_.erase(version);  // some chunk was corrupt: ask for all of them again
    return Arrival::kRejected;
  }
  return Arrival::kCompleted;
}

NetworkStore::Assembly& NetworkStore::Open(NetworkVersion version, int64_t crc32c, int64_t now_us) {
  const auto found = versions_.find(version);
  if (found != versions_.end()) {
    return found->second;
  }
  MakeRoom();
  Assembly& assembly = versions_[version];
  assembly.values = std::make_shared<Vector>(parameters_);
  assembly.missing_chunks = ChunkCount(parameters_);
  assembly.received.assign(static_cast<size_t>(assembly.missing_chunks), 0);
  assembly.crc32c = crc32c;
  assembly.last_arrival_us = now_us;
  asked_us_.erase(version);
  return assembly;
}

void NetworkStore::MakeRoom() {
  size_t unwanted = 0;
  auto oldest = versions_.end();
  for (auto it = versions_.begin(); it != versions_.end(); ++it) {
    if (!wanted_.contains(it->first)) {
      ++unwanted;
      if (oldest == versions_.end() || it->first.second < oldest->first.second) {
        oldest = it;
      }
    }
  }
  if (unwanted >= kSpareVersions) {
    versions_.erase(oldest);
  }
}

std::shared_ptr<const Vector> NetworkStore::Find(NetworkVersion version) const {
  const auto found = versions_.find(version);
  return found != versions_.end() && found->second.complete() ? found->second.values : nullptr;
}

std::vector<chunk_range_t> NetworkStore::MissingRanges(int64_t now_us, int64_t quiet_us) {
  std::vector<chunk_range_t> ranges;
  std::erase_if(asked_us_, [&](const auto& entry) { return !wanted_.contains(entry.first); });
  for (const NetworkVersion& version : wanted_) {
    const auto found = versions_.find(version);
    if (found == versions_.end()) {
      const int64_t since_us = asked_us_.try_emplace(version, now_us).first->second;
      if (now_us - since_us >= quiet_us && ranges.size() < kMaximumMissingRanges) {
        ranges.push_back(Range(version, 0, ChunkCount(parameters_)));
      }
    } else if (!found->second.complete() && now_us - found->second.last_arrival_us >= quiet_us) {
      AppendMissing(version, found->second, ranges);
    }
  }
  return ranges;
}

void NetworkStore::AppendMissing(NetworkVersion version, const Assembly& assembly,
                                 std::vector<chunk_range_t>& ranges) const {
  const int chunks = static_cast<int>(assembly.received.size());
  for (int first = 0; first < chunks && ranges.size() < kMaximumMissingRanges; ++first) {
    if (assembly.received[static_cast<size_t>(first)] == 0) {
      int end = first + 1;
      while (end < chunks && assembly.received[static_cast<size_t>(end)] == 0) {
        ++end;
      }
      ranges.push_back(Range(version, first, end - first));
      first = end;
    }
  }
}

std::vector<chunk_range_t> NetworkStore::HeldVersions() const {
  std::vector<chunk_range_t> held;
  for (auto it = versions_.rbegin(); it != versions_.rend() && held.size() < kMaximumHeldVersions; ++it) {
    if (it->second.complete()) {
      held.push_back(Range(it->first, 0, static_cast<int>(it->second.received.size())));
    }
  }
  return held;
}

}  // namespace fresco
