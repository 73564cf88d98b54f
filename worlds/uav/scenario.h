// A scenario defines the world of one field of sensors, in SI units. Plain values. UavWorld (uav_world.h)
// checks what depends on several of them; msgs/proto/experiment.proto has the range and the default of each.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace fresco {

class ObstacleMap;

/// The most sensors of a scenario: a transition with so many still fits one Ethernet frame
/// (msgs/lcm/transitions_t.lcm).
inline constexpr int kMaximumSensors = 250;

/// A cell of the grid. Its centre is at (column, row) * cell_m.
struct Cell {
  int column = 0;  ///< from the west, 0, 1, ..
  int row = 0;     ///< from the south, 0, 1, ..
  bool operator==(const Cell&) const = default;
};

struct Sensor {
  double x_m = 0;     ///< metres east of the centre of cell (0, 0)
  double y_m = 0;     ///< metres north of it
  double weight = 1;  ///< importance; theta_n = weight_n / sum of weights
};

/// The channel.
struct Radio {
  double bandwidth_hz = 0;   ///< B
  double update_bits = 0;    ///< M, bits of one status update
  double noise_dbm = 0;      ///< sigma^2, noise power
  double gain_at_1m_db = 0;  ///< beta_0, channel gain at one metre
  double altitude_m = 0;     ///< h, altitude of the UAV
};

/// The rotor: the parameters of PropulsionPower (physics.h).
struct Rotor {
  double blade_profile_power_w = 0;
  double induced_power_w = 0;
  double tip_speed_mps = 0;
  double induced_velocity_mps = 0;
  double drag_ratio = 0;
  double air_density_kgpm3 = 0;
  double solidity = 0;
  double disk_area_m2 = 0;
};

/// The constants of eq. (reward), in which AoI counts with weights theta_n that sum to one.
struct Reward {
  double k1 = 0;  ///< penalty if the stop can't be reached in time, phi < 0
  double k2 = 0;  ///< penalty if the energy does not last to the stop, Delta < 0
  double k3 = 0;  ///< bonus for arriving
};

struct Scenario {
  int columns = 0;
  int rows = 0;
  double cell_m = 0;  ///< side of a cell
  int slots = 0;      ///< T, slots of a flight
  double slot_s = 0;  ///< tau, length of a slot
  Cell start;         ///< cell over which every flight begins
  Cell stop;          ///< cell over which it has to end
  std::vector<Sensor> sensors;
  double coverage_radius_m = 0;  ///< R
  double initial_energy_j = 0;   ///< E_max, energy on board at the start
  Radio radio;
  Rotor rotor;
  double speed_mps = 0;  ///< V
  Reward reward;
  std::optional<int> maximum_aoi;  ///< delta_max, AoI grows no further, slots; none: no limit
  /// Obstacles (obstacle_map.h), as many columns and rows as the scenario has; null: an open grid.
  std::shared_ptr<const ObstacleMap> map;
};

/// The horizontal distance of a sensor from a cell's centre, metres. Unlike std::hypot, it has the same bits
/// with every mathematical library. `cell_m` is the side of a cell.
double HorizontalDistance(Cell cell, double cell_m, const Sensor& sensor);

/// The tolerance of IsWithin: a billionth.
inline constexpr double kRadiusLeeway = 1 + 1e-9;

/// Whether a sensor at this horizontal distance is covered: it is at most R, with the tolerance. So a radius
/// converted to a transmission power and back covers the same cells, and so does one whose last bits depend
/// on the mathematical library.
inline bool IsWithin(double coverage_radius_m, double distance_m) {
  return distance_m <= coverage_radius_m * kRadiusLeeway;
}

/// Returns `count` >= 0 sensors of weight 1 at random places, uniform over the whole area of the grid, which
/// reaches half a cell beyond the centres of the outermost cells. A pure function of its arguments; any
/// thread may call it.
std::vector<Sensor> RandomSensors(int columns, int rows, double cell_m, int count, uint64_t seed);

/// The same for a scenario. If it has a map, the sensors stand in the centres of `count` different cells,
/// drawn from those without an obstacle (CellKind::kFree, kStartAndLanding) that flights from the start lead
/// to. Throws UsageError if there are fewer of these.
std::vector<Sensor> RandomSensors(const Scenario& scenario, int count, uint64_t seed);

}  // namespace fresco
