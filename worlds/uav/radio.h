// Coverage radius and transmission power of a sensor (paper, eq. for R). Pure.
#pragma once

#include "worlds/uav/scenario.h"

namespace fresco {

/// R = sqrt(beta0 P / ((2^(M / (B tau)) - 1) sigma^2) - h^2), in metres, for a transmission power in
/// watts. Throws UsageError where the power can't reach the ground from the UAV's altitude.
double CoverageRadius(const Radio& radio, double slot_s, double transmit_power_w);

/// The power in watts that gives the radius: the inverse of CoverageRadius. 0.07564 W for 100 m
/// with Table I.
double TransmitPower(const Radio& radio, double slot_s, double coverage_radius_m);

}  // namespace fresco
