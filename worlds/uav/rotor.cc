#include "worlds/uav/rotor.h"

#include <cmath>

namespace fresco {

double PropulsionPower(const Rotor& rotor, double speed_mps) {
  const double speed_squared = speed_mps * speed_mps;
  const double tip_speed_squared = rotor.tip_speed_mps * rotor.tip_speed_mps;
  const double blade_profile_w = rotor.blade_profile_power_w * (1 + 3 * speed_squared / tip_speed_squared);
  const double x = speed_squared / (2 * rotor.induced_velocity_mps * rotor.induced_velocity_mps);
  const double induced_w = rotor.induced_power_w / std::sqrt(std::hypot(1.0, x) + x);
  const double parasite_w = 0.5 * rotor.drag_ratio * rotor.air_density_kgpm3 * rotor.solidity *
                            rotor.disk_area_m2 * speed_squared * speed_mps;
  return blade_profile_w + induced_w + parasite_w;
}

}  // namespace fresco
