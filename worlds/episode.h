// The record of one episode, in any world, and the one loop that records it. Everything that acts (the
// actor's flyer, baselines, the planner, the learner's check) records in this way. Deterministic; no I/O.
// Only one thread at a time may use an object.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "worlds/world.h"

namespace fresco {

/// Consecutive transitions of one episode; usually all of them. Transition i takes actions[i] in state i,
/// earns rewards[i] and leads to state i + 1.
struct Episode {
  uint64_t seed = 0;                ///< decides where the episode begins
  Ending ending = Ending::kNone;    ///< after the last transition
  std::vector<float> states;        ///< [(transitions + 1) x the world's state_size]
  std::vector<int16_t> actions;     ///< [transitions]
  std::vector<float> rewards;       ///< [transitions]
  std::vector<uint8_t> next_masks;  ///< [transitions x MaskSize]: the actions allowed in the next state

  int transitions() const { return static_cast<int>(actions.size()); }
  /// State i, 0 to transitions().
  std::span<const float> state(size_t i) const {
    const size_t size = states.size() / (actions.size() + 1);
    return std::span(states).subspan(i * size, size);
  }
  /// Leaves the room of the vectors for another episode.
  void Clear();
  /// Gives back the room that vectors have beyond their content.
  void ShrinkToFit();
};

/// Bytes of a mask over so many actions: bit a % 8 of byte a / 8 is 1 if action a is allowed.
inline int MaskSize(int actions) {
  return (actions + 7) / 8;
}

/// Appends a mask with one byte for each action as bits, filled up to a byte.
void AppendMask(std::span<const uint8_t> mask, std::vector<uint8_t>& packed);

/// Whether the mask after transition i allows an action, in a world with so many actions.
bool IsAllowedNext(const Episode& episode, size_t i, int action, int actions);

/// The sum of the rewards, without discount, added in their order.
double Return(const Episode& episode);

/// By how many percent a score is above the least possible one. If the latter is only a lower bound, the
/// result says how large the gap is at most; whoever shows it must say so.
double GapPercent(double score, double least_score);

/// Draws one of the allowed actions, all alike; `mask` has 1 or 0 for each action. CHECKs that one is
/// allowed.
int RandomAllowedAction(std::span<const uint8_t> mask, RandomStream& stream);

/// The memory of the longest episode of the world, the object itself included, bytes.
int64_t LongestEpisodeBytes(const World& world);

/// Whether what happened in two episodes is the same to the bit, whatever their seeds.
bool SameBits(const Episode& a, const Episode& b);

/// An environment that records what is done in it.
class EpisodeRecorder {
 public:
  /// Makes an environment; only Begin may be called next. `world` must outlive the object.
  explicit EpisodeRecorder(const World& world);
  /// The same, and begins the episode that the seed determines.
  EpisodeRecorder(const World& world, uint64_t seed) : EpisodeRecorder(world) { Begin(seed); }

  /// Begins the episode that the seed determines. Forgets the one before, and allocates nothing while
  /// episodes are not longer than the longest before.
  void Begin(uint64_t seed);

  const Environment& environment() const { return *environment_; }
  /// The present state.
  std::span<const float> state() const {
    return std::span(episode_.states).last(static_cast<size_t>(world_->state_size()));
  }
  /// The actions that are allowed now, one byte each.
  const std::vector<uint8_t>& mask() const { return mask_; }
  const Episode& episode() const { return episode_; }
  bool ended() const { return episode_.ending != Ending::kNone; }
  /// Moves the episode out; afterwards only Reuse, Begin and the destructor may be called.
  Episode Release() { return std::move(episode_); }
  /// Takes the room of an episode for the next one.
  void Reuse(Episode&& episode) { episode_ = std::move(episode); }

  /// Takes an action. CHECKs as Environment::Step does; the action may be one that the mask forbids.
  void Step(int action);

 private:
  void AddState();

  const World* world_;
  std::unique_ptr<Environment> environment_;
  std::vector<uint8_t> mask_;
  Episode episode_;
};

/// Takes `actions` in the episode of the seed until it ends, and ignores the rest of them. Returns false if
/// an action is not allowed, or if the episode has not ended after the last; what is recorded is then
/// unspecified.
bool FlyActions(uint64_t seed, std::span<const int16_t> actions, EpisodeRecorder& recorder);
/// The same, with a recorder of its own.
bool FlyActions(const World& world, uint64_t seed, std::span<const int16_t> actions, Episode& episode);

}  // namespace fresco
