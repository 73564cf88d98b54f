#include "actors/network_store.h"

#include <algorithm>
#include <tuple>

#include "core/bytes.h"

namespace fresco {
namespace {

// How many versions are kept besides the wanted ones. The next orders will probably name these.
constexpr size_t kSpareVersions = 8;
// If the learner sends no chunk of a version for so long, it has dropped the version or never made it.
constexpr int64_t kGivenUpUs = 500'000;

}  // namespace

int64_t NetworkStore::BytesFor(int64_t parameters, int64_t wanted) {
  const int64_t of_version = static_cast<int64_t>(sizeof(Assembly)) +
                             parameters * static_cast<int64_t>(sizeof(Vector::Scalar)) +
                             ChunkCount(parameters);
  return (wanted + static_cast<int64_t>(kSpareVersions)) * of_version;
}

NetworkStore::Arrival NetworkStore::Add(NetworkKind kind, const weights_t& message, int64_t now_us) {
  const int chunk = ChunkIndex(message, parameters_);
  if (chunk < 0) {
    return Arrival::kRejected;
  }
  const NetworkVersion version{kind, message.version};
  Assembly& assembly = Open(version, message, now_us);
  const bool contradicts = assembly.crc32c != message.crc32c;
  if (contradicts && assembly.complete()) {
    return Arrival::kRejected;
  }
  if (contradicts) {
    Begin(assembly, message.crc32c, now_us);  // one of the two CRCs is wrong, but which is not known
  }
  assembly.last_arrival_us = now_us;
  if (assembly.received[static_cast<size_t>(chunk)] != 0) {
    return Arrival::kDuplicate;
  }
  std::copy(message.values.begin(), message.values.end(), assembly.values->data() + message.offset);
  assembly.received[static_cast<size_t>(chunk)] = 1;
  if (--assembly.missing_chunks == 0) {
    return Complete(version, assembly, now_us);
  }
  return contradicts ? Arrival::kRestarted : Arrival::kAccepted;
}

NetworkStore::Arrival NetworkStore::Complete(NetworkVersion version, const Assembly& assembly,
                                             int64_t now_us) {
  if (Crc32c(Values(*assembly.values)) != static_cast<uint32_t>(assembly.crc32c)) {
    versions_.erase(version);  // some chunk was corrupt: ask for all of them again
    return Arrival::kRejected;
  }
  ++completed_versions_;
  longest_assembly_us_ = std::max(longest_assembly_us_, now_us - assembly.first_arrival_us);
  return Arrival::kCompleted;
}

NetworkStore::Assembly& NetworkStore::Open(NetworkVersion version, const weights_t& message, int64_t now_us) {
  const auto found = versions_.find(version);
  if (found != versions_.end()) {
    return found->second;
  }
  MakeRoom();
  Assembly& assembly = versions_[version];
  assembly.values = std::make_shared<Vector>(parameters_);
  Begin(assembly, message.crc32c, now_us);
  asked_us_.erase(version);
  return assembly;
}

void NetworkStore::Begin(Assembly& assembly, int64_t crc32c, int64_t now_us) const {
  assembly.missing_chunks = ChunkCount(parameters_);
  assembly.received.assign(static_cast<size_t>(assembly.missing_chunks), 0);
  assembly.crc32c = crc32c;
  assembly.first_arrival_us = now_us;
  assembly.last_arrival_us = now_us;
}

/// Forgets unwanted versions until at most kSpareVersions - 1 are left, first those of which nothing has
/// arrived for the longest time. It does not go by version number: after a learner was resumed, or in a
/// forged message, a high number does not mean that the version is needed.
void NetworkStore::MakeRoom() {
  std::vector<std::tuple<int64_t, int32_t, NetworkKind>> unwanted;
  for (const auto& [version, assembly] : versions_) {
    if (!wanted_.contains(version)) {
      unwanted.emplace_back(assembly.last_arrival_us, version.number, version.kind);
    }
  }
  std::sort(unwanted.begin(), unwanted.end());
  for (size_t i = 0; i + kSpareVersions <= unwanted.size(); ++i) {
    versions_.erase({std::get<NetworkKind>(unwanted[i]), std::get<int32_t>(unwanted[i])});
  }
}

void NetworkStore::SetWanted(std::set<NetworkVersion> wanted) {
  wanted_ = std::move(wanted);
  for (const NetworkKind kind : {NetworkKind::kCurrent, NetworkKind::kTarget}) {
    const auto oldest = wanted_.lower_bound({kind, 0});
    if (oldest != wanted_.end() && oldest->kind == kind) {
      oldest_wanted_[kind] = oldest->number;
    }
  }
}

std::shared_ptr<const Vector> NetworkStore::Find(NetworkVersion version) const {
  const auto found = versions_.find(version);
  return found != versions_.end() && found->second.complete() ? found->second.values : nullptr;
}

std::vector<chunk_range_t> NetworkStore::MissingRanges(int64_t now_us) {
  std::vector<chunk_range_t> ranges;
  std::erase_if(asked_us_, [&](const auto& entry) { return !wanted_.contains(entry.first); });
  for (const NetworkVersion& version : wanted_) {
    const auto found = versions_.find(version);
    if (found == versions_.end()) {
      const int64_t since_us = asked_us_.try_emplace(version, now_us).first->second;
      if (now_us - since_us >= kQuietVersionUs && ranges.size() < kMaximumMissingRanges) {
        ranges.push_back(ChunkRange(version, 0, ChunkCount(parameters_)));
      }
    } else if (!found->second.complete() && now_us - found->second.last_arrival_us >= kQuietVersionUs) {
      AppendMissing(version, found->second, ranges);
    }
  }
  for (const auto& [version, assembly] : versions_) {
    if (IsOnItsWay(version, assembly, now_us)) {
      AppendMissing(version, assembly, ranges);
    }
  }
  return ranges;
}

bool NetworkStore::IsOnItsWay(NetworkVersion version, const Assembly& assembly, int64_t now_us) const {
  const int64_t quiet_us = now_us - assembly.last_arrival_us;
  const auto oldest = oldest_wanted_.find(version.kind);
  return !assembly.complete() && !wanted_.contains(version) && quiet_us >= kQuietVersionUs &&
         quiet_us < kGivenUpUs && (oldest == oldest_wanted_.end() || version.number >= oldest->second);
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
      ranges.push_back(ChunkRange(version, first, end - first));
      first = end;
    }
  }
}

int NetworkStore::MissingChunks(NetworkVersion version) const {
  const auto found = versions_.find(version);
  return found == versions_.end() ? ChunkCount(parameters_) : found->second.missing_chunks;
}

std::vector<chunk_range_t> NetworkStore::HeldVersions() const {
  std::vector<chunk_range_t> held;
  for (auto it = versions_.rbegin(); it != versions_.rend() && held.size() < kMaximumHeldVersions; ++it) {
    if (it->second.complete()) {
      held.push_back(ChunkRange(it->first, 0, static_cast<int>(it->second.received.size())));
    }
  }
  return held;
}

}  // namespace fresco
