// Tiny scenarios for exhaustive search, of every kind that the exact planner has to tell apart.
#pragma once

#include <cstdint>

#include "worlds/uav/scenario.h"

namespace fresco {

/// 1 x 1 to 4 x 3 cells, up to 10 slots, 1 to 3 sensors, any slack from zero on; half of them with an energy
/// that allows only some hovers (or, by the literature's rotor, only some flown slots); weights whole,
/// fractional or zero; a third with a cap on the AoI. Always valid.
Scenario TinyScenario(uint32_t index);

/// Whether fewer slots than the flight's can be spent on whichever of hovering and flying takes more energy.
bool EnergyBinds(const Scenario& scenario);
bool HoveringIsDearer(const Scenario& scenario);

}  // namespace fresco
