// The paper's formulas of section II: the propulsion power of the rotary-wing UAV, and the radius from which
// a sensor reaches it. Pure functions; any thread may call them.
#pragma once

#include "worlds/uav/scenario.h"

namespace fresco {

/// Returns the power in watts at a speed >= 0 in m/s. With Table I it is 219.82 W hovering and 112.876 W at
/// 25 m/s. The induced term contains sqrt(1 + x^2) - x, where x = V^2 / (2 v0^2); it is computed as 1 /
/// (sqrt(1 + x^2) + x), which is accurate for any induced velocity > 0.
double PropulsionPower(const Rotor& rotor, double speed_mps);

/// Throws UsageError if an update takes more than 100 bit/s/Hz, M / (B tau): no signal could carry it.
void CheckRadio(const Radio& radio, double slot_s);

/// Returns R = sqrt(beta0 P / ((2^(M / (B tau)) - 1) sigma^2) - h^2), in metres, for a transmission power P
/// in watts. With Table I, 0.07564 W reach 100 m. Throws UsageError if the power is too small to reach the
/// UAV at its altitude, and as CheckRadio does.
double CoverageRadius(const Radio& radio, double slot_s, double transmit_power_w);

}  // namespace fresco
