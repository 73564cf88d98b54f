// Counter-based random numbers: a stream is a pure function of its key, so any draw of any episode
// can be made again anywhere, in any order. No other source of randomness may reach the weights. Any thread
// may call the functions; a stream belongs to one thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace fresco {

/// Philox4x32-10 (Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", SC'11): the block
/// of four 32-bit words at `counter` under `key`.
std::array<uint32_t, 4> Philox4x32(std::array<uint32_t, 4> counter, std::array<uint32_t, 2> key);

/// What a stream is for; streams of different purposes never share a draw. The values are part of
/// what makes runs repeatable: append, never renumber.
enum class RandomPurpose : uint32_t {
  kActing = 1,           ///< epsilon-greedy choices of an episode, by its own seed; indices: slot, 0
  kReplaySampling = 2,   ///< mini-batches; indices: update low, update high
  kInitialWeights = 3,   ///< indices: layer, 0
  kSensorPlacement = 4,  ///< indices: 0, 0
  kTest = 5,             ///< tests and soak runs only
  kEpisodeSeed = 6,      ///< seeds of training episodes; indices: episode low, episode high
  kEpisodeStart = 7,     ///< where a world's episode starts, by its own seed; indices: 0, 0
  kEvaluationSeed = 8,   ///< seeds of evaluation episodes; indices: episode low, episode high
  kSearchOrders = 9,  ///< which training episodes search, from where on; indices: episode low, episode high
};

/// The stream of (seed, purpose, first index, second index). Small and copyable.
class RandomStream {
 public:
  RandomStream(uint64_t seed, RandomPurpose purpose, uint32_t first_index, uint32_t second_index);

  /// Uniform over all 32-bit words.
  uint32_t NextWord();

  /// Uniform in [0, 1), 53 random bits.
  double NextUniform();

  /// Uniform in {0, .., bound - 1}, without bias; bound >= 1.
  uint32_t NextBelow(uint32_t bound);

 private:
  std::array<uint32_t, 2> key_;
  std::array<uint32_t, 4> counter_;
  std::array<uint32_t, 4> block_{};
  int used_ = 4;
};

}  // namespace fresco
