// A flown episode, or a run of consecutive transitions of one, in memory; and its way over the wire
// in messages that each fit one Ethernet frame. Pure; an object belongs to one thread at a time.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "msgs/wire.h"
#include "worlds/uav/environment.h"
#include "worlds/uav/world.h"

namespace fresco {

/// Transition i goes from states[i] to states[i + 1].
struct Episode {
  int64_t order_index = 0;
  int32_t first_transition = 0;        ///< 0 for a whole episode
  Outcome outcome = Outcome::kFlying;  ///< other than kFlying: the last transition is terminal
  std::vector<State> states;           ///< transitions + 1
  std::vector<int16_t> actions;
  std::vector<float> rewards;
  std::vector<float> td_errors;
  std::vector<uint8_t> next_masks;  ///< mask_size bytes a transition, bit a % 8 of byte a / 8

  int transitions() const { return static_cast<int>(actions.size()); }
  void Clear();
};

/// What the longest episode of the world takes of memory, the object itself included.
int64_t LongestEpisodeBytes(const World& world);

/// Bytes of one mask over the world's actions.
inline int MaskSize(const World& world) {
  return (world.actions() + 7) / 8;
}

/// Appends a mask of one byte an action as bits, to a whole byte.
void AppendMask(std::span<const uint8_t> mask, std::vector<uint8_t>& packed);

/// Transitions that fit one message for this many sensors; at least 1 for up to kMaximumSensors.
int TransitionsPerMessage(int sensors);

/// Splits a whole episode into messages, each of which fits one frame, and calls `send` with each in their
/// order. They have no run and no time yet (MessageBus::Publish).
void SplitEpisode(const World& world, const Episode& episode, int64_t actor_id,
                  const std::function<void(const transitions_t&)>& send);

/// A message's run of transitions, checked against the world: sizes, actions, cells, AoI, finite
/// values. Returns false where anything is off.
bool ToEpisodeRun(const World& world, const transitions_t& message, Episode& run);

}  // namespace fresco
