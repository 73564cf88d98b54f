// Scenarios that the tests of worlds/ and planner/ share.
#pragma once

#include <cstdint>

#include "core/random.h"
#include "worlds/uav/environment.h"

namespace fresco {

/// Table I with sensors over cells (8,7), (1,4), (18,19): the instance of docs/results/README.md.
Scenario TableOneScenario();

/// The rotor usual in the literature; flying at 25 m/s costs it more than hovering.
Rotor LiteratureRotor();

/// Grids of 1 x 1 to 5 x 5, up to nine slots of slack, 1 to 4 sensors of any weight, either rotor, an
/// energy between just enough and plenty, sometimes a cap on the AoI. Always valid.
Scenario RandomScenario(uint32_t index);

/// A stream of its own for each test and case.
RandomStream TestStream(uint32_t test, uint32_t index);

/// A whole number drawn uniformly from low .. high.
int Between(RandomStream* stream, int low, int high);

/// An action drawn uniformly from those that the mask admits.
Action RandomAction(const World& world, const Environment& environment, MaskOptions options,
                    RandomStream* stream);

}  // namespace fresco
