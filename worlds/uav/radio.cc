#include "worlds/uav/radio.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "worlds/uav/scenario_check.h"

namespace fresco {
namespace {

double FromDecibel(double decibel) {
  return std::pow(10.0, decibel / 10.0);
}

// (2^(M / (B tau)) - 1) sigma^2 / beta0: the transmission power in watts for each square metre of
// squared distance.
double PowerPerSquareMetre(const Radio& radio, double slot_s) {
  CheckRadio(radio, slot_s);
  const double spectral_efficiency = radio.update_bits / (radio.bandwidth_hz * slot_s);
  const double wanted_signal_to_noise = std::expm1(spectral_efficiency * std::numbers::ln2);
  const double noise_w = FromDecibel(radio.noise_dbm - 30);  // 0 dBm is a milliwatt
  return wanted_signal_to_noise * noise_w / FromDecibel(radio.gain_at_1m_db);
}

}  // namespace

double CoverageRadius(const Radio& radio, double slot_s, double transmit_power_w) {
  const double power_per_square_metre = PowerPerSquareMetre(radio, slot_s);
  const double altitude_squared = radio.altitude_m * radio.altitude_m;
  const double radius_squared = transmit_power_w / power_per_square_metre - altitude_squared;
  if (!(radius_squared >= 0) || !std::isfinite(radius_squared)) {
    throw UsageError(fmt::format(
        "scenario.transmit_power_w: {} is out of range: a sensor needs {} W to reach the UAV from "
        "the ground below it (scenario.radio.altitude_m: {}); allowed: any finite power from that on",
        transmit_power_w, altitude_squared * power_per_square_metre, radio.altitude_m));
  }
  return std::sqrt(radius_squared);
}

double TransmitPower(const Radio& radio, double slot_s, double coverage_radius_m) {
  RequireWithin("scenario.coverage_radius_m", coverage_radius_m, 0, 1e6);
  const double distance_squared = coverage_radius_m * coverage_radius_m + radio.altitude_m * radio.altitude_m;
  return distance_squared * PowerPerSquareMetre(radio, slot_s);
}

}  // namespace fresco
