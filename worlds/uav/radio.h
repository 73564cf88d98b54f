// Computes the coverage radius from the transmission power of a sensor and back (paper, eq. for R). Pure
// functions; any thread may call them. Both throw UsageError if a value of `radio` or `slot_s` is out of
// range (worlds/uav/scenario_check.h).
#pragma once

#include "worlds/uav/scenario.h"

namespace fresco {

/// Returns R = sqrt(beta0 P / ((2^(M / (B tau)) - 1) sigma^2) - h^2), in metres, for a transmission power P
/// in watts. Throws UsageError if the power is too small to reach the UAV at its altitude.
double CoverageRadius(const Radio& radio, double slot_s, double transmit_power_w);

/// The inverse of CoverageRadius: returns the power in watts for a radius in metres. With Table I, 100 m take
/// 0.07564 W.
double TransmitPower(const Radio& radio, double slot_s, double coverage_radius_m);

}  // namespace fresco
