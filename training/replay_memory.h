// The replay memory D of Algorithm 1: a ring that holds the latest transitions as the network sees them. The
// trainer owns it. Not thread-safe. Does not allocate after construction.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/random.h"
#include "nn/mlp.h"

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

  Matrix observations;              ///< [inputs x batch]
  Matrix next_observations;         ///< [inputs x batch]
  std::vector<int16_t> actions;     ///< [batch]
  std::vector<float> rewards;       ///< [batch]
  std::vector<uint8_t> terminal;    ///< [batch]; 1: the episode ended, so there is no action in s'
  std::vector<float> least_values;  ///< [batch]; a lower bound of Q(s, a); -infinity if none is known
  std::vector<uint8_t> next_masks;  ///< [batch x actions]; see next_mask
};

/// One transition (s, a, r, s') to insert.
struct Transition {
  std::span<const float> observation;       ///< s as the network sees it, [inputs]
  std::span<const float> next_observation;  ///< s' as the network sees it, [inputs]
  int16_t action = 0;
  float reward = 0;
  bool terminal = false;
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
  void Copy(int64_t index, int column, MiniBatch& batch) const;
  static size_t MaskBytes(int actions) { return (static_cast<size_t>(actions) + 7) / 8; }

  int actions_;
  int64_t capacity_;
  int64_t size_ = 0;
  int64_t next_ = 0;
  Matrix observations_;
  Matrix next_observations_;
  std::vector<int16_t> action_;
  std::vector<float> reward_;
  std::vector<uint8_t> terminal_;
  std::vector<float> least_value_;
  size_t mask_size_;
  std::vector<uint8_t> masks_;
};

/// Remembers the actions of the latest transitions. A checkpoint stores these instead of the replay memory:
/// the world is deterministic, so everything else follows from the actions. Only the constructor and Actions
/// allocate.
class ActionHistory {
 public:
  /// `capacity` (>= 1): transitions in the replay memory. `longest_episode` (>= 1): the most transitions that
  /// an episode can have.
  ActionHistory(int64_t capacity, int longest_episode);

  /// The memory of an object, bytes.
  static int64_t BytesFor(int64_t capacity, int longest_episode) {
    return (capacity + longest_episode) * static_cast<int64_t>(sizeof(Entry));
  }

  /// Adds the action of the next transition; `last` says whether it ends its episode.
  void Add(int16_t action, bool last);

  /// Returns the actions of complete episodes, oldest first, so that they contain the latest `capacity`
  /// transitions (or all, if there were fewer). The first episode may begin before these. The transition
  /// added last must have ended its episode.
  std::vector<int16_t> Actions() const;

 private:
  struct Entry {
    int16_t action = 0;
    bool last = false;
  };
  const Entry& Latest(int64_t age) const;  // age 0 is the latest, age 1 the one before it

  int64_t capacity_;
  std::vector<Entry> ring_;
  int64_t added_ = 0;
};

}  // namespace fresco
