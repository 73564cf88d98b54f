// What the network sees of the UAV's world: turns a state into the input of the network. Immutable after
// construction, so any number of threads may share one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "worlds/uav/map_input.h"
#include "worlds/uav/scenario.h"
#include "worlds/uav/ways.h"
#include "worlds/world.h"

namespace fresco {

class UavWorld;

struct NetworkInputOptions {
  /// Adds to the paper's state which sensors the UAV covers and how far away each one is. Both follow from
  /// o_t and the scenario, but without this option the network has to learn them.
  bool sensor_geometry = false;
  /// Makes an input for agent.set_network, which always has the geometry.
  bool sets = false;
};

/// The part of a field that an observation for agent.set_network is made of, besides the state.
struct ObservedField {
  int columns = 0;
  int rows = 0;
  double cell_m = 0;
  double initial_energy_j = 0;  ///< E_max
  int slots = 0;                ///< T
  double coverage_radius_m = 0;
  Cell stop;
  std::span<const Sensor> sensors;
  const ObstacleMap* map = nullptr;     ///< if there is one
  const MapInput* map_input = nullptr;  ///< of this map
};

// Where WriteSets writes what changes from slot to slot: two of the UAV's own numbers, and one of a sensor's.
inline constexpr int kTimeMarginInput = 4;
inline constexpr int kEnergyMarginInput = 5;
inline constexpr int kAoiInput = 5;

/// Weights are summed in whole numbers of such parts, so that their order changes no bit of the sum.
inline constexpr double kPartsOfWeight{uint64_t{1} << 32};

/// What a world states about an observation for agent.set_network with at most so many sensors.
ObservationSets SetsOf(int sensors);

/// Writes an observation for agent.set_network. First the UAV's own numbers: column, row, the way to the stop
/// (columns, rows), phi / T, Delta / E_max, R. Then for each sensor: 1, the way to it (east, north), its
/// distance, 1 if it is covered or else 0, delta_n / T and theta_n. Lengths are divided by the grid's longer
/// side. `state` begins with the fields of a UavWorld (uav_world.h); entries behind those of the sensors are
/// 0, as for sensors that the field does not have. The order of the sensors changes no bit of an entry.
/// Behind the UAV's own numbers come the kWayInputs (ways.h) of the way to the stop, and behind those of each
/// sensor those of the way to the nearest cell that covers it: round the obstacles if there is a map.
void WriteSets(const ObservedField& field, std::span<const float> state, std::span<float> input);

/// With `sets`, the input is that of WriteSets.
///
/// Otherwise the entries of the input are column / (columns - 1), row / (rows - 1), delta_n / T for each of
/// the N sensors, phi / T and Delta / E_max. With sensor_geometry, there follow N entries of 1 or 0 (sensor n
/// is covered or not) and N distances to the sensors, divided by the grid's longer side (with a
/// map: the moves to the nearest cell that covers it, divided by the longer side in cells, at most 2). If the
/// grid has one column (or row), that entry is 0.
class NetworkInput {
 public:
  /// `world` must outlive the object.
  NetworkInput(const UavWorld& world, NetworkInputOptions options);

  /// The number of entries for so many sensors.
  static int Size(int sensors, NetworkInputOptions options);
  /// The memory of the tables, bytes.
  int64_t bytes() const {
    return static_cast<int64_t>(geometry_.size() * sizeof(geometry_[0])) +
           (map_input_ ? map_input_->bytes() : 0);
  }

  /// Writes the entries to `input` for a state as floats (uav_world.h says where each field is). CHECKs both
  /// sizes.
  void Write(std::span<const float> state, std::span<float> input) const;

 private:
  const UavWorld* world_;
  NetworkInputOptions options_;
  std::optional<MapInput> map_input_;  // with `sets` and a map
  std::vector<float> geometry_;        // for every cell: N times covered or not, then N distances
};

}  // namespace fresco
