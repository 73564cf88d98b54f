// Which chunks of which network versions are to be sent: each new version once, and again what
// actors report missing. Says what to send next; pacing and sending are the caller's. Not thread-safe.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "msgs/weights_codec.h"
#include "nn/mlp.h"

namespace fresco {

class WeightPublisher {
 public:
  /// What a version takes of memory beside its parameters.
  static int64_t BytesPerVersion(int64_t parameters);

  /// Offers a version; all its chunks are due.
  void Offer(NetworkKind kind, int32_t version, std::shared_ptr<const Vector> parameters);

  /// Drops versions older than those that any order can still name.
  void Retain(int32_t oldest_current, int32_t oldest_target);

  /// An actor lacks these chunks: those that were not sent within the last `kAnswerAgainUs` are due
  /// again, once, however many ask. Unknown versions and chunks are ignored.
  void Request(const chunk_range_t& range, int64_t now_us);

  /// The next due chunk, without its identity, and of which network; none: nothing is due.
  std::optional<std::pair<NetworkKind, weights_t>> Next(int64_t now_us);

  /// For people: which versions are on offer, and how many of their chunks are due.
  std::string Offered() const;

  /// Chunks sent, and those of them that were asked for.
  int64_t sent_chunks() const { return sent_chunks_; }
  int64_t repeated_chunks() const { return repeated_chunks_; }

 private:
  struct Version {
    std::shared_ptr<const Vector> parameters;
    uint32_t crc32c = 0;
    std::vector<uint8_t> due;      // by chunk
    std::vector<int64_t> sent_us;  // by chunk; 0: never
    int due_count = 0;
    int next = 0;  // where to look for the next due chunk
  };

  std::map<std::pair<int32_t, NetworkKind>, Version> versions_;  // oldest first
  int64_t sent_chunks_ = 0;
  int64_t repeated_chunks_ = 0;
};

}  // namespace fresco
