// The network store holds the network versions of one run that an actor has or is assembling from chunks. It
// hands a version out only if every chunk is there and the CRC of all values is right, so an actor never uses
// a mixed or damaged network. Memory is bounded. All times are monotonic microseconds. An actor owns one for
// each run that it serves. Not thread-safe.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <vector>

#include "msgs/protocol_times.h"
#include "msgs/weights_codec.h"
#include "nn/network.h"

namespace fresco {

class NetworkStore {
 public:
  /// `parameters` (>= 1): number of values in each network.
  explicit NetworkStore(int64_t parameters) : parameters_(parameters) {}

  /// The most memory of an object while `wanted` versions are wanted, bytes.
  static int64_t BytesFor(int64_t parameters, int64_t wanted);

  enum class Arrival {
    kAccepted,   ///< the chunk was missing
    kDuplicate,  ///< the chunk was there already
    kCompleted,  ///< it was the last missing chunk, and the CRC is right
    kRestarted,  ///< it has another CRC than the chunks before; these were discarded and assembly began again
    kRejected,   ///< it contradicts the network's size or a complete version, or the CRC of all
                 ///< values is wrong
  };

  /// Adds a chunk of a network of this kind that arrived at `now_us`. If the version is new and there is no
  /// room, the store forgets a version that SetWanted did not name.
  Arrival Add(NetworkKind kind, const weights_t& message, int64_t now_us);

  /// Returns the parameters of a version; null if the version is not complete.
  std::shared_ptr<const Vector> Find(NetworkVersion version) const;

  /// Says which versions the actor's orders need. The store keeps these, and MissingRanges reports their
  /// missing chunks. It may forget any other version to make room.
  void SetWanted(std::set<NetworkVersion> wanted);

  /// Returns the missing chunks that the actor should ask for, at most kMaximumMissingRanges ranges. Reports
  /// a version only if nothing of it has arrived for kQuietVersionUs. Wanted versions come first. Incomplete
  /// versions that the next orders will probably name follow: a chunk of it arrived within the last half
  /// second, and it is not older than the oldest wanted version of the same network.
  std::vector<chunk_range_t> MissingRanges(int64_t now_us);

  /// Returns the complete versions, at most kMaximumHeldVersions, each as the range of all its chunks.
  std::vector<chunk_range_t> HeldVersions() const;

  /// The number of missing chunks of a version; the number of all its chunks if none has arrived.
  int MissingChunks(NetworkVersion version) const;
  /// The number of versions completed so far, and the longest time from a version's first chunk to its
  /// completion.
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
  std::map<NetworkVersion, int64_t> asked_us_;  // since when each wanted version without any chunk is wanted
  std::set<NetworkVersion> wanted_;
  std::map<NetworkKind, int32_t> oldest_wanted_;  // of each network; stays if no version of it is wanted now
  int64_t completed_versions_ = 0;
  int64_t longest_assembly_us_ = 0;
};

}  // namespace fresco
