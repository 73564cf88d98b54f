// The replay memory D of Algorithm 1: a ring of the latest transitions, as the network sees them.
// Not thread-safe. No allocation after construction.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/random.h"
#include "nn/mlp.h"

namespace fresco {

/// A mini-batch, one transition a column or entry.
struct MiniBatch {
  MiniBatch(int inputs, int actions, int batch_size);

  /// What it takes of memory beside the object itself.
  static int64_t BytesFor(int inputs, int actions, int batch_size);

  int size() const { return static_cast<int>(actions.size()); }

  Matrix observations;       ///< [inputs x batch]
  Matrix next_observations;  ///< [inputs x batch]
  std::vector<int16_t> actions;
  std::vector<float> rewards;
  std::vector<uint8_t> terminal;    ///< 1: no next state
  std::vector<float> least_values;  ///< Q(s, a) is known to be no smaller; -infinity: nothing is known
  Matrix next_penalty;              ///< [actions x batch]: 0 where allowed in s', -infinity where not
};

/// One transition, for inserting.
struct Transition {
  std::span<const float> observation;
  std::span<const float> next_observation;
  int16_t action = 0;
  float reward = 0;
  bool terminal = false;
  std::span<const uint8_t> next_mask;  ///< packed bits
  float least_value = -std::numeric_limits<float>::infinity();
};

class ReplayMemory {
 public:
  ReplayMemory(int inputs, int actions, int64_t capacity);

  /// What it takes of memory beside the object itself, once it is full.
  static int64_t BytesFor(int inputs, int actions, int64_t capacity);

  void Insert(const Transition& transition);

  /// An empty memory goes on as if `transitions` had been inserted and were forgotten: the next one takes
  /// the place that it would have.
  void BeginAt(int64_t transitions) { next_ = transitions % capacity_; }

  /// Transitions held, at most the capacity.
  int64_t size() const { return size_; }

  /// Fills the batch with transitions drawn uniformly, with replacement. CHECKs that there is one.
  void Sample(RandomStream& stream, MiniBatch& batch) const;

 private:
  void Copy(int64_t place, int column, MiniBatch& batch) const;
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

}  // namespace fresco
