// A scenario: everything that defines the world of one field of sensors, in SI units. Plain values;
// `World` (world.h) checks them and derives the rest. Defaults are the paper's Table I.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace fresco {

/// A transition of so many sensors still fits one Ethernet frame (msgs/lcm/transitions_t.lcm).
inline constexpr int kMaximumSensors = 250;

struct Cell {
  int column = 0;
  int row = 0;
  bool operator==(const Cell&) const = default;
};

struct Sensor {
  double x_m = 0;
  double y_m = 0;
  double weight = 1;  ///< importance; theta_n = weight_n / sum of weights
};

/// Table I, channel part; converted to linear units by radio.cc.
struct Radio {
  double bandwidth_hz = 1e6;
  double update_bits = 5e6;
  double noise_dbm = -100;
  double gain_at_1m_db = -60;
  double altitude_m = 120;
};

/// Table I, rotor part.
struct Rotor {
  double blade_profile_power_w = 99.66;
  double induced_power_w = 120.16;
  double tip_speed_mps = 120;
  double induced_velocity_mps = 0.002;
  double drag_ratio = 0.48;
  double air_density_kgpm3 = 1.225;
  double solidity = 0.0001;
  double disk_area_m2 = 0.5;
};

/// Constants of eq. (reward), on the scale of theta_n = weight_n / sum of weights.
struct Reward {
  double k1 = 1;  ///< penalty when the stop is out of reach in time, phi < 0
  double k2 = 1;  ///< penalty when the energy does not suffice, Delta < 0
  double k3 = 1;  ///< bonus for arriving
};

struct Scenario {
  int columns = 20;
  int rows = 20;
  double cell_m = 25;
  int slots = 70;     ///< T
  double slot_s = 1;  ///< tau
  Cell start{10, 0};
  Cell stop{10, 19};
  std::vector<Sensor> sensors;
  double coverage_radius_m = 100;
  double initial_energy_j = 22000;  ///< E_max
  Radio radio;
  Rotor rotor;
  double speed_mps = 25;  ///< V
  Reward reward;
  std::optional<int> maximum_aoi;  ///< delta_max; none: no cap below T
};

/// `count` >= 0 sensors of weight 1, uniform over the whole area of the grid (cells reach half a cell
/// beyond the outermost centres), a pure function of the seed.
std::vector<Sensor> RandomSensors(int columns, int rows, double cell_m, int count, uint64_t seed);

}  // namespace fresco
