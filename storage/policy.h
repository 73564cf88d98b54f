// Reads and flies the policies that --policy can name: baselines, trained networks, the exact optimum. The
// functions may be called from any thread.
#pragma once

#include <string>

#include "planner/planner.h"
#include "storage/network_file.h"
#include "worlds/uav/aoi_figures.h"

namespace fresco {

inline constexpr char kAoiPolicy[] = "aoi";
inline constexpr char kDistancePolicy[] = "distance";
inline constexpr char kOptimalPolicy[] = "optimal";

/// The possible values of --policy, for texts.
inline constexpr char kPolicyKinds[] =
    "aoi, distance, optimal, the folder of a run (with a best.network), a network file or a checkpoint";

/// Whether this policy needs no file: aoi, distance or optimal.
bool IsBuiltInPolicy(const std::string& policy);

/// Reads the network that a path names. The path may be a network file, the folder of a run (its
/// best.network) or a checkpoint (its best network so far). Throws UsageError that says what a policy can be
/// if the path is none of these.
StoredNetwork ReadPolicy(const std::string& policy);

/// Flies one greedy episode of a network in `world`, with the masks of `experiment`. Throws UsageError if the
/// network is for another number of sensors.
Episode FlyNetwork(const World& world, const Experiment& experiment, const StoredNetwork& network);

/// The limits of a search for the optimum.
struct PlannerLimits {
  double seconds = 0;                                    ///< wall time; 0: no limit
  int64_t memory_bytes = PlannerOptions{}.memory_bytes;  ///< memory for tables and labels
  bool show_progress = false;  ///< whether to show a line of progress on standard error
};

/// Searches for the exact optimum until it is proved, a limit is reached or the program is asked to stop.
/// Returns the best flight found.
Plan PlanWithin(const World& world, const PlannerLimits& limits);

}  // namespace fresco
