// Whole episodes of any world by a rule, for tests.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "core/random.h"
#include "worlds/episode.h"

namespace fresco {

/// The action in a state.
using Rule = std::function<int(std::span<const float>)>;

/// The episode of the seed, with the rule's action in each state.
inline Episode Play(const World& world, uint64_t seed, const Rule& rule) {
  EpisodeRecorder recorder(world, seed);
  while (!recorder.ended()) {
    recorder.Step(rule(recorder.state()));
  }
  return recorder.Release();
}

/// Draws uniformly from so many actions, whatever the state.
inline Rule RandomActions(uint64_t seed, int actions) {
  return [stream = RandomStream(seed, RandomPurpose::kTest, 0, 0), actions](std::span<const float>) mutable {
    return static_cast<int>(stream.NextBelow(static_cast<uint32_t>(actions)));
  };
}

}  // namespace fresco
