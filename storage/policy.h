// The policies that can be flown greedily: baselines, trained networks, the exact optimum.
#pragma once

#include <string>

#include "planner/planner.h"
#include "storage/network_file.h"
#include "worlds/uav/flight.h"

namespace fresco {

inline constexpr char kAoiPolicy[] = "aoi";
inline constexpr char kDistancePolicy[] = "distance";
inline constexpr char kOptimalPolicy[] = "optimal";

/// What --policy can be.
inline constexpr char kPolicyKinds[] =
    "aoi, distance, optimal, the folder of a run (with a best.network), a network file or a checkpoint";

/// Whether the name is that of a policy that needs no file.
bool IsBuiltInPolicy(const std::string& policy);

/// The network that a path given by a person stands for: that of a network file, the best evaluated one
/// of a run's folder or of a checkpoint. Throws UsageError that says what a policy can be if it stands for
/// none.
StoredNetwork ReadPolicy(const std::string& policy);

/// One greedy episode of a network in `world`, with the masks of `experiment`. Throws UsageError if the
/// network is for another number of sensors.
Flight FlyNetwork(const World& world, const Experiment& experiment, const StoredNetwork& network);

/// How long and with how much memory a person lets the planner search.
struct PlannerLimits {
  double seconds = 0;  ///< 0: to the end
  int64_t memory_bytes = PlannerOptions{}.memory_bytes;
  bool show_progress = false;  ///< a line on standard error now and then
};

/// Searches for the exact optimum until it is found, a limit is reached or the program is asked to stop.
Plan PlanWithin(const World& world, const PlannerLimits& limits);

}  // namespace fresco
