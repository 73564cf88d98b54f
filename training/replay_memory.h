// The replay memory D of Algorithm 1: a ring that holds the latest transitions as the network sees them. The
// trainer owns it. Not thread-safe. Does not allocate after construction.
#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "core/random.h"
#include "nn/network.h"
#include "worlds/episode.h"

namespace fresco {

/// A mini-batch: column or entry i of each member belongs to transition i.
struct MiniBatch {
  MiniBatch(int inputs, int actions, int batch_size);

  /// The memory of a mini-batch, bytes.
  static int64_t BytesFor(int inputs, int actions, int batch_size);

  int size() const { return static_cast<int>(actions.size()); }
  /// The actions allowed in s' of one transition: 1 or 0 for each.
  std::span<const uint8_t> next_mask(int column) const {
    const size_t count = next_masks.size() / actions.size();
    return std::span(next_masks).subspan(static_cast<size_t>(column) * count, count);
  }

  Matrix observations;           ///< [inputs x batch]
  Matrix next_observations;      ///< [inputs x batch]
  std::vector<int16_t> actions;  ///< [batch]
  std::vector<float> rewards;    ///< [batch]
  std::vector<float> discounts;  ///< [batch]; how much the value of s' counts; 0 if the episode ended there
  std::vector<float> least_values;  ///< [batch]; a lower bound of Q(s, a); -infinity if none is known
  std::vector<uint8_t> next_masks;  ///< [batch x actions]; see next_mask
};

/// One transition (s, a, r, s') to insert. It may stand for several that follow each other: then s' is the
/// state behind the last of them, and r is what they earned.
struct Transition {
  std::span<const float> observation;       ///< s as the network sees it, [inputs]
  std::span<const float> next_observation;  ///< s' as the network sees it, [inputs]
  int16_t action = 0;
  float reward = 0;
  float discount = 0;                  ///< as in MiniBatch
  std::span<const uint8_t> next_mask;  ///< actions allowed in s': bit a % 8 of byte a / 8
  float least_value = -std::numeric_limits<float>::infinity();  ///< as in MiniBatch
};

class ReplayMemory {
 public:
  /// `inputs`: entries of an observation. `actions`: number of actions. `capacity` (>= 1): transitions held
  /// at most.
  ReplayMemory(int inputs, int actions, int64_t capacity);

  /// The memory of an object when it is full, bytes.
  static int64_t BytesFor(int inputs, int actions, int64_t capacity);

  /// Copies the transition into the ring. If the ring is full, the oldest transition is overwritten. CHECKs
  /// sizes.
  void Insert(const Transition& transition);

  /// For a memory that is still empty: the next transition is inserted at the index of the ring that it would
  /// have after `transitions` (>= 0) earlier ones.
  void BeginAt(int64_t transitions) { next_ = transitions % capacity_; }

  /// Transitions held, at most the capacity.
  int64_t size() const { return size_; }

  /// Fills the batch with transitions drawn uniformly, with replacement. CHECKs that the memory is not empty.
  void Sample(RandomStream& stream, MiniBatch& batch) const;

 private:
  /// A transition as it is stored. Its parts follow each other, so that a sample takes few lines of the
  /// cache.
  struct Rest {
    float reward;
    float discount;
    float least_value;
    int16_t action;
  };
  float* Record(int64_t index) { return records_.data() + static_cast<size_t>(index) * record_size_; }
  const float* Record(int64_t index) const {
    return records_.data() + static_cast<size_t>(index) * record_size_;
  }
  void Prefetch(int64_t index) const;
  void Copy(int64_t index, int column, MiniBatch& batch) const;

  size_t inputs_;
  int actions_;
  size_t mask_size_;    // bytes
  size_t record_size_;  // floats: s, s', Rest, the mask
  int64_t capacity_;
  int64_t size_ = 0;
  int64_t next_ = 0;
  std::vector<float> records_;
};

/// Keeps the episodes of the latest transitions. A checkpoint stores these instead of the replay memory,
/// which holds only what the network sees.
class EpisodeHistory {
 public:
  /// `capacity` (>= 1): transitions in the replay memory.
  explicit EpisodeHistory(int64_t capacity) : capacity_(capacity) {}

  /// The memory of an object that is full of the longest episodes, bytes. Short ones take some more for each
  /// transition.
  static int64_t BytesFor(const World& world, int64_t capacity);

  /// Adds the next complete episode, and forgets the oldest ones that the latest `capacity` transitions do
  /// not need.
  void Add(std::shared_ptr<const Episode> episode);

  /// Oldest first.
  std::vector<std::shared_ptr<const Episode>> episodes() const {
    return {episodes_.begin(), episodes_.end()};
  }

 private:
  int64_t capacity_;
  int64_t transitions_ = 0;  // of all episodes kept
  std::deque<std::shared_ptr<const Episode>> episodes_;
};

}  // namespace fresco
