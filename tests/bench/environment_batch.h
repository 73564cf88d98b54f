// Many environments of one world side by side, as arrays that a batch of a neural network can use at once:
// row i of each array belongs to environment i. For the peers that fresco bench and tests/bench compare with.
// Only one thread at a time may use an object. The arrays stay where they are as long as it lives.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "msgs/experiment.h"
#include "worlds/episode.h"

namespace fresco {

class EnvironmentBatch {
 public:
  /// `count` (>= 1): the number of environments. None of them flies before Reset.
  EnvironmentBatch(const Experiment& experiment, int count);

  int count() const { return static_cast<int>(recorders_.size()); }
  const World& world() const { return experiment_.world(); }

  /// Begins an episode in each of the first seeds.size() environments. The others do not fly.
  void Reset(std::span<const uint64_t> seeds);

  /// Each environment that flies takes its action; `actions` has count() entries, and the others are ignored.
  /// Returns how many environments fly on. CHECKs that the actions exist.
  int Step(std::span<const int64_t> actions);

  /// What the network sees now: [count x observation_size].
  std::vector<float>& observations() { return observations_; }
  /// The actions that are allowed now, 1 or 0: [count x actions].
  std::vector<uint8_t>& masks() { return masks_; }
  /// The rewards of the last step; 0 in an environment that did not fly: [count].
  std::vector<float>& rewards() { return rewards_; }
  /// How the episode of each environment ended (Ending): [count].
  std::vector<uint8_t>& endings() { return endings_; }

  /// The episode of an environment so far.
  const Episode& episode(int environment) const { return Recorder(environment).episode(); }

  /// Excursions: whether each environment is at its place (0, 1, ...); false if the place is negative. Both
  /// have count() entries.
  void AreAt(std::span<const int32_t> places, std::span<uint8_t> at) const;
  /// Writes 1 for each action that is allowed now and leads to the environment's place, else 0; the whole
  /// mask if the place is negative: [count x actions].
  void MasksTowards(std::span<const int32_t> places, std::span<uint8_t> masks) const;

 private:
  const EpisodeRecorder& Recorder(int environment) const {
    return recorders_[static_cast<size_t>(environment)];
  }
  void WriteRow(size_t environment);

  Experiment experiment_;
  size_t observation_size_;
  size_t actions_;
  std::vector<EpisodeRecorder> recorders_;
  std::vector<float> observations_;
  std::vector<uint8_t> masks_;
  std::vector<float> rewards_;
  std::vector<uint8_t> endings_;
  std::vector<uint8_t> flies_;  // whether an environment has an episode that has not ended
};

}  // namespace fresco
