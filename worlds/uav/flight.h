// What an episode in the UAV's world is: a flight. Reads flights from episodes, and flies them with a policy.
// Pure; any thread may call these functions.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "worlds/episode.h"
#include "worlds/uav/uav_environment.h"

namespace fresco {

/// The cell o_t of a state.
inline Cell CellIn(std::span<const float> state) {
  return {static_cast<int>(state[kColumnField]), static_cast<int>(state[kRowField])};
}

/// State i of an episode that begins at the start: that of slot i + 1.
UavState StateIn(const Episode& episode, size_t i);
/// All of its states.
std::vector<UavState> StatesIn(const Episode& episode);

/// How the episode ended.
Outcome OutcomeOf(const Episode& episode);
inline bool Arrived(const Episode& episode) {
  return OutcomeOf(episode) == Outcome::kArrived;
}

/// The action in state i. In the last state nothing is decided: hover, schedule 0.
Action ActionIn(const UavWorld& world, const Episode& episode, size_t i);

/// Joules on board in state i of an episode that begins at the start.
double EnergyIn(const UavWorld& world, const Episode& episode, size_t i);

/// Joules on board at the end of an episode that begins at the start.
inline double ResidualEnergy(const UavWorld& world, const Episode& episode) {
  return EnergyIn(world, episode, episode.actions.size());
}

/// Flies one episode from the start with the actions of `policy`, also those that the world's mask forbids.
Episode Fly(const UavWorld& world, const std::function<Action(const UavEnvironment&)>& policy);

}  // namespace fresco
