// Scenarios, actions and parts of episodes that tests share.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/random.h"
#include "worlds/uav/flight.h"

namespace fresco {

/// Table I with sensors over cells (8,7), (1,4), (18,19): the instance of docs/results/README.md.
Scenario TableOneScenario();

/// The rotor usual in the literature; flying at 25 m/s costs it more than hovering.
Rotor LiteratureRotor();

/// Table I over a random grid of at most so many cells, with random start and stop.
Scenario RandomGrid(int most_columns, int most_rows, RandomStream* stream);

/// Moves from the start to the stop, round the obstacles of the map, if there is one.
int MovesToStop(const Scenario& scenario);

/// Grids of 1 x 1 to 5 x 5, up to nine slots of slack, 1 to 4 sensors of any weight, either rotor, an
/// energy between just enough and plenty, sometimes a cap on the AoI. Always valid.
Scenario RandomScenario(uint32_t index);

/// The same with a map: cells of all kinds, at most 5 x 5, between which the stop can be reached.
Scenario RandomMapScenario(uint32_t index);

/// Puts a random map under a scenario whose start and stop are on the grid, such that flights lead from one
/// to the other. Slots and energy may be too few then.
void AddRandomMap(Scenario* scenario, RandomStream* stream);

/// A stream of its own for each test and case.
RandomStream TestStream(uint32_t test, uint32_t index);

/// A whole number drawn uniformly from low .. high.
int Between(RandomStream* stream, int low, int high);

/// The index of an action drawn uniformly from those that the mask admits.
int RandomAllowed(std::span<const uint8_t> mask, RandomStream* stream);
/// The same for a mask with these options.
Action RandomAction(const UavWorld& world, const UavEnvironment& environment, MaskOptions options,
                    RandomStream* stream);

/// The state as its fields, in the order of UavWorld's description.
std::vector<float> FieldsOf(const UavState& state);

/// Transitions first .. first + count - 1 of an episode.
inline Episode PartOf(const World& world, const Episode& episode, int first, int count) {
  Episode part;
  const auto copy = [&](const auto& from, auto& to, int extra, int scale) {
    to.assign(from.begin() + first * scale, from.begin() + (first + count) * scale + extra);
  };
  part.ending = first + count == episode.transitions() ? episode.ending : Ending::kNone;
  copy(episode.states, part.states, world.state_size(), world.state_size());
  copy(episode.actions, part.actions, 0, 1);
  copy(episode.rewards, part.rewards, 0, 1);
  copy(episode.next_masks, part.next_masks, 0, MaskSize(world.actions()));
  return part;
}

}  // namespace fresco
