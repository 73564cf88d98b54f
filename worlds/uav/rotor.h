// Propulsion power of the rotary-wing UAV (paper, first equation of section II). Pure.
#pragma once

#include "worlds/uav/scenario.h"

namespace fresco {

/// Power in watts at a speed in m/s >= 0. Numerically stable for any induced velocity > 0: the
/// induced term's difference is computed as 1 / (sqrt(1 + x^2) + x), x = V^2 / (2 v0^2).
/// Table I: 219.82 W hovering, 112.876 W at 25 m/s.
double PropulsionPower(const Rotor& rotor, double speed_mps);

}  // namespace fresco
