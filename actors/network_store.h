// The network versions that an actor holds or is assembling from chunks. A version is handed out
// only when every chunk is there and the CRC of the whole holds, so nobody ever acts with a mixed or
// corrupt network. Memory is bounded. Not thread-safe.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "msgs/weights_codec.h"
#include "nn/mlp.h"

namespace fresco {

/// One version of one of the two networks.
using NetworkVersion = std::pair<NetworkKind, int32_t>;

/// No chunk of a version for so long: what is missing of it was lost.
inline constexpr int64_t kQuietUs = 4'000;
/// Between two reports of missing chunks.
inline constexpr int64_t kRequestPeriodUs = 8'000;

class NetworkStore {
 public:
  /// For networks of `parameters` values.
  explicit NetworkStore(int64_t parameters) : parameters_(parameters) {}

  /// What it takes of memory at most while so many versions are wanted.
  static int64_t BytesFor(int64_t parameters, int64_t wanted);

  enum class Arrival {
    kAccepted,   ///< a new chunk
    kDuplicate,  ///< a chunk that is there
    kCompleted,  ///< the last missing chunk, and the CRC holds
    kRestarted,  ///< contradicts the CRC of an incomplete version, which begins anew with this chunk
    kRejected,   ///< contradicts the network's size or a complete version's CRC
  };

  /// Takes a chunk that arrived at `now_us` (monotonic).
  Arrival Add(NetworkKind kind, const weights_t& message, int64_t now_us);

  /// The parameters of a complete version; null where it is not (yet) complete.
  std::shared_ptr<const Vector> Find(NetworkVersion version) const;

  /// Names the versions that orders need: others are forgotten as room is needed, and of these the
  /// missing chunks are reported.
  void SetWanted(std::set<NetworkVersion> wanted);

  /// Ranges of missing chunks of versions of which nothing has arrived for kQuietUs: first of the wanted
  /// ones, then of those that are on their way, which the next orders will name: some chunk came within the
  /// last half second, and they are no older than the oldest wanted of late. At most
  /// kMaximumMissingRanges.
  std::vector<chunk_range_t> MissingRanges(int64_t now_us);

  /// Complete versions, at most kMaximumHeldVersions, as {kind, version, 0, chunks}.
  std::vector<chunk_range_t> HeldVersions() const;

  /// Missing chunks of a version, all of them where nothing of it is here.
  int MissingChunks(NetworkVersion version) const;
  /// Versions completed so far, and the longest time from the first chunk of one to its completion.
  int64_t completed_versions() const { return completed_versions_; }
  int64_t longest_assembly_us() const { return longest_assembly_us_; }

 private:
  struct Assembly {
    std::shared_ptr<Vector> values;
    std::vector<uint8_t> received;  // by chunk
    int missing_chunks = 0;
    int64_t crc32c = 0;
    int64_t first_arrival_us = 0;
    int64_t last_arrival_us = 0;
    bool complete() const { return missing_chunks == 0; }
  };

  Assembly& Open(NetworkVersion version, const weights_t& message, int64_t now_us);
  void Begin(Assembly& assembly, int64_t crc32c, int64_t now_us) const;
  Arrival Complete(NetworkVersion version, const Assembly& assembly, int64_t now_us);
  void MakeRoom();
  bool IsOnItsWay(NetworkVersion version, const Assembly& assembly, int64_t now_us) const;
  void AppendMissing(NetworkVersion version, const Assembly& assembly,
                     std::vector<chunk_range_t>& ranges) const;

  int64_t parameters_;
  std::map<NetworkVersion, Assembly> versions_;
  std::map<NetworkVersion, int64_t> asked_us_;  // wanted versions of which nothing is here: since when
  std::set<NetworkVersion> wanted_;
  std::map<NetworkKind, int32_t> oldest_wanted_;  // where orders named one; otherwise the last such
  int64_t completed_versions_ = 0;
  int64_t longest_assembly_us_ = 0;
};

}  // namespace fresco
