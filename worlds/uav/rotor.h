// Computes the propulsion power of the rotary-wing UAV (paper, first equation of section II). A pure
// function; any thread may call it.
#pragma once

#include "worlds/uav/scenario.h"

namespace fresco {

/// Returns the power in watts at a speed >= 0 in m/s. With Table I it is 219.82 W hovering and 112.876 W at
/// 25 m/s. The induced term contains sqrt(1 + x^2) - x, where x = V^2 / (2 v0^2); it is computed as 1 /
/// (sqrt(1 + x^2) + x), which is accurate for any induced velocity > 0.
double PropulsionPower(const Rotor& rotor, double speed_mps);

}  // namespace fresco
