// What the network sees of the UAV's world: turns a state into the input of the network. Immutable after
// construction, so any number of threads may share one.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "worlds/uav/map_input.h"
#include "worlds/uav/scenario.h"
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

/// With `sets`, the entries of the input are column / (columns - 1), row / (rows - 1), the stop's columns and
/// rows from here / S, phi / T and Delta / E_max; then for each sensor 1, its metres to the east and to the
/// north of here and its distance, each / (S * cell_m), 1 or 0 (it is covered or not), delta_n / T and N *
/// theta_n. S is the larger number of columns and rows. If the scenario has a map, MapInput's way to the stop
/// follows the UAV's own inputs, and its way to the sensor those of each sensor.
///
/// Otherwise the entries of the input are column / (columns - 1), row / (rows - 1), delta_n / T for each of
/// the N sensors, phi / T and Delta / E_max. With sensor_geometry, there follow N entries of 1 or 0 (sensor n
/// is covered or not) and N distances to the sensors, divided by the grid's longer side (with a
/// map: the moves to the nearest cell that covers it, divided by S, at most 2). If the grid has one column
/// (or row), that entry is 0.
class NetworkInput {
 public:
  /// `world` must outlive the object.
  NetworkInput(const UavWorld& world, NetworkInputOptions options);

  /// The number of entries for so many sensors, with a map or without one.
  static int Size(int sensors, NetworkInputOptions options, bool has_map = false);
  /// What a world states about an input with `sets`; none without it.
  static std::optional<ObservationSets> Sets(int sensors, NetworkInputOptions options, bool has_map = false);
  /// The memory of the tables, bytes.
  int64_t bytes() const {
    return static_cast<int64_t>(geometry_.size() * sizeof(geometry_[0])) +
           (map_input_ ? map_input_->bytes() : 0);
  }

  /// Writes the entries to `input` for a state as floats (uav_world.h says where each field is). CHECKs both
  /// sizes.
  void Write(std::span<const float> state, std::span<float> input) const;

 private:
  void WriteSets(std::span<const float> state, std::span<float> input) const;

  const UavWorld* world_;
  NetworkInputOptions options_;
  std::optional<MapInput> map_input_;  // with `sets` and a map
  std::vector<float> geometry_;        // for every cell: N times covered or not, then N distances
};

}  // namespace fresco
