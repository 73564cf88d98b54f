// Decides which chunks of which network versions to send next: every chunk of a new version once, and chunks
// that actors report missing once more. The caller paces and sends them. All times are monotonic
// microseconds. LearnerNode owns it. Not thread-safe.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "msgs/weights_codec.h"
#include "nn/network.h"

namespace fresco {

class WeightPublisher {
 public:
  /// The memory of a version without its parameters, bytes.
  static int64_t BytesPerVersion(int64_t parameters);

  /// Adds a version, all of whose chunks are then due.
  void Offer(NetworkVersion version, std::shared_ptr<const Vector> parameters);

  /// Drops the versions of the two networks that are older than these: no order can name them any more.
  void Retain(int32_t oldest_current, int32_t oldest_target);

  /// Makes these chunks due again, since an actor lacks them. A chunk that was sent within the last 6 ms is
  /// left out, and a chunk that is due already stays due once, however many actors ask. Ignores unknown
  /// versions and chunks.
  void Request(const chunk_range_t& range, int64_t now_us);

  /// Returns the next due chunk and its network, and counts the chunk as sent; nullopt if nothing is due. The
  /// caller fills in `utime`, `run_id` and `config_hash`.
  std::optional<std::pair<NetworkKind, weights_t>> Next(int64_t now_us);

  /// A text for people: the versions on offer, and how many of their chunks are due.
  std::string StateText() const;

  /// The number of chunks sent, and how many of these were sent again because an actor asked.
  int64_t sent_chunks() const { return sent_chunks_; }
  int64_t repeated_chunks() const { return repeated_chunks_; }

 private:
  struct Offered {
    std::shared_ptr<const Vector> parameters;
    uint32_t crc32c = 0;
    std::vector<uint8_t> due;      // by chunk
    std::vector<int64_t> sent_us;  // by chunk; 0: never
    int due_count = 0;
    int next = 0;  // number of the chunk where the search for the next due one begins
  };

  struct OlderFirst {
    bool operator()(NetworkVersion a, NetworkVersion b) const;
  };

  std::map<NetworkVersion, Offered, OlderFirst> versions_;
  int64_t sent_chunks_ = 0;
  int64_t repeated_chunks_ = 0;
};

}  // namespace fresco
