#include "worlds/uav/physics.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/error.h"

namespace fresco {
namespace {

// The largest M / (B tau), bits per second and hertz. The required signal-to-noise ratio grows as two to this
// power.
constexpr double kMaximumSpectralEfficiency = 100;

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

double PropulsionPower(const Rotor& rotor, double speed_mps) {
  const double speed_squared = speed_mps * speed_mps;
  const double tip_speed_squared = rotor.tip_speed_mps * rotor.tip_speed_mps;
  const double blade_profile_w = rotor.blade_profile_power_w * (1 + 3 * speed_squared / tip_speed_squared);
  const double x = speed_squared / (2 * rotor.induced_velocity_mps * rotor.induced_velocity_mps);
  const double induced_w = rotor.induced_power_w / std::sqrt(std::sqrt(1 + x * x) + x);
  const double parasite_w = 0.5 * rotor.drag_ratio * rotor.air_density_kgpm3 * rotor.solidity *
                            rotor.disk_area_m2 * speed_squared * speed_mps;
  return blade_profile_w + induced_w + parasite_w;
}

void CheckRadio(const Radio& radio, double slot_s) {
  const double spectral_efficiency = radio.update_bits / (radio.bandwidth_hz * slot_s);
  if (spectral_efficiency > kMaximumSpectralEfficiency) {
    throw UsageError(fmt::format(
        "scenario.radio.update_bits: {} in scenario.slot_s: {} over scenario.radio.bandwidth_hz: {} makes {} "
        "bit/s/Hz; allowed: at most {}",
        radio.update_bits, slot_s, radio.bandwidth_hz, spectral_efficiency, kMaximumSpectralEfficiency));
  }
}

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

}  // namespace fresco
