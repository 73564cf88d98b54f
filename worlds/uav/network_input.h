// What the network sees of a state. Immutable after construction, so any number of threads may share one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "worlds/uav/world.h"

namespace fresco {

struct NetworkInputOptions {
  /// Beside the paper's state: which sensors the UAV covers and how far away each of them is. Both follow
  /// from o_t and the scenario; a network has to find them out otherwise.
  bool sensor_geometry = false;
};

/// The network's input: [column/(columns-1), row/(rows-1), delta_n/T (N of them), phi/T, Delta/E_max] and,
/// with sensor_geometry, [covered_n (N, 0 or 1), distance_n (N, in units of the grid's longer side)]; a
/// grid of one column or row gives 0 along it.
class NetworkInput {
 public:
  /// `world` must outlive it.
  NetworkInput(const World& world, NetworkInputOptions options);

  /// Entries for so many sensors.
  static int Size(int sensors, NetworkInputOptions options);
  int size() const { return Size(world_->sensors(), options_); }
  /// What it takes of memory beside the object itself.
  static int64_t BytesFor(const World& world, NetworkInputOptions options);

  /// `input` has size() entries. A pure function of the state as it is on the wire, so that actor and
  /// learner see the same bits.
  void Write(const State& state, std::span<float> input) const;

 private:
  const World* world_;
  NetworkInputOptions options_;
  std::vector<float> geometry_;  // covered_n and distance_n of every cell
};

}  // namespace fresco
