// What was flown: the record of one episode, and the one loop that records it. Everything that flies (the
// actor's flyer, baselines, the planner, the learner's check) records in this way. Deterministic; no I/O.
// Only one thread at a time may use an object.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "worlds/uav/environment.h"

namespace fresco {

/// Consecutive transitions of one episode; usually all of them. Transition i takes actions[i] in states[i],
/// earns rewards[i] and leads to states[i + 1].
struct Episode {
  Outcome outcome =
      Outcome::kFlying;  ///< after the last transition; if it is not kFlying, that transition is terminal
  std::vector<State> states;     ///< transitions + 1
  std::vector<int16_t> actions;  ///< indices of actions (World::ActionIndex)
  std::vector<float> rewards;
  std::vector<uint8_t> next_masks;  ///< MaskSize bytes for each transition, bit a % 8 of byte a / 8

  int transitions() const { return static_cast<int>(actions.size()); }
  bool arrived() const { return outcome == Outcome::kArrived; }
  void Clear();
};

/// Bytes of one mask over the world's actions.
inline int MaskSize(const World& world) {
  return (world.actions() + 7) / 8;
}

/// Appends a mask with one byte for each action as bits, filled up to a byte.
void AppendMask(std::span<const uint8_t> mask, std::vector<uint8_t>& packed);

/// The memory of the longest episode of the world, the object itself included, bytes.
int64_t LongestEpisodeBytes(const World& world);

/// The action in states[slot]. In the last state nothing is decided: hover, schedule 0.
Action ActionIn(const World& world, const Episode& episode, size_t slot);

/// Joules on board in states[slot] of an episode that begins at the start.
double EnergyIn(const World& world, const Episode& episode, size_t slot);

/// Joules on board at the end of an episode that begins at the start.
inline double ResidualEnergy(const World& world, const Episode& episode) {
  return EnergyIn(world, episode, episode.actions.size());
}

/// Whether the transitions of `part` are, to the bit, those of `episode` from transition `first` on, and its
/// outcome is `episode`'s if they reach its end, otherwise kFlying.
bool IsPartOf(const Episode& part, int first, const Episode& episode);

/// An environment that records what is flown in it.
class EpisodeRecorder {
 public:
  /// Begins an episode. `world` must outlive the object. `mask_options` says which masks to record.
  EpisodeRecorder(const World& world, MaskOptions mask_options);

  const Environment& environment() const { return environment_; }
  /// The actions that are allowed now, one byte each.
  const std::vector<uint8_t>& mask() const { return mask_; }
  const Episode& episode() const { return episode_; }
  /// Moves the episode out; afterwards only the destructor may be called.
  Episode Release() { return std::move(episode_); }

  /// Flies one slot. CHECKs as Environment::Step does; the action may be one that the mask forbids.
  void Step(int action);

 private:
  const World* world_;
  MaskOptions mask_options_;
  Environment environment_;
  std::vector<uint8_t> mask_;
  Episode episode_;
};

/// Flies one episode from the start with the actions of `policy`. Its masks allow everything.
Episode Fly(const World& world, const std::function<Action(const Environment&)>& policy);

/// Flies `actions` from the start until the episode ends, and ignores the rest of them. Returns false if an
/// action is not allowed, or if the episode has not ended after the last; `episode` is then unspecified.
bool FlyActions(const World& world, MaskOptions mask_options, std::span<const int16_t> actions,
                Episode& episode);

}  // namespace fresco
