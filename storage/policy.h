// Reads from the command line which policy to fly in which world, and flies it greedily: a reference policy
// of the world, a trained network or the exact optimum. For `evaluate`, `fly` and reports. Any thread may
// call these functions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "msgs/experiment.h"
#include "planner/planner.h"
#include "storage/network_file.h"

namespace CLI {
class App;
}

namespace fresco {

/// The limits of a search for the optimum.
struct PlannerLimits {
  double seconds = 0;                                    ///< wall time; 0: no limit
  int64_t memory_bytes = PlannerOptions{}.memory_bytes;  ///< memory for tables and labels
  bool show_progress = false;  ///< whether to show a line of progress on standard error
};

/// The values of the command line options.
struct PolicyChoice {
  std::string config;                 ///< empty: the configuration of the trained policy, or
                                      ///< kDefaultExperiment
  std::vector<std::string> settings;  ///< path=value, applied to the configuration
  std::string policy;
  int search_width = 0;  ///< 0: a network acts greedily; otherwise its values guide a search (BeamSearch)
  PlannerLimits limits;
};

/// Adds --config, --set, --policy, --search, --time-limit-s and --memory-limit-mb, whose values parsing
/// writes to `choice`.
void AddPolicyOptions(CLI::App& app, PolicyChoice& choice);

/// A policy and the experiment in whose world it acts, read and checked.
struct ChosenPolicy {
  Experiment experiment;
  std::optional<StoredNetwork> network;  ///< none if the policy is a reference policy or the optimum
};

/// Reads the files that the choice names. Throws UsageError if they can't be used or do not fit together.
ChosenPolicy ReadChoice(const PolicyChoice& choice);

/// Reads the network of the folder of a run (its best.network), a network file or a checkpoint (its best
/// network so far). Throws UsageError that begins with `option` and says what a policy can be if `policy` is
/// none of these or can't be read.
StoredNetwork ReadTrainedNetwork(const std::string& policy, const std::string& option);

/// The experiment whose training starts from the network of a policy: the folder of a run, a network file or
/// a checkpoint, as `option` names it. Throws UsageError if that can't be read or is not of the same size.
Experiment StartFrom(const Experiment& experiment, const std::string& policy,
                     const std::string& option = "--start-from");

/// An episode of a policy, and the experiment that defines its world.
struct FlownPolicy {
  Experiment experiment;
  Episode episode;
  std::optional<Plan> plan = std::nullopt;  ///< set if the policy is "optimal"

  const World& world() const { return experiment.world(); }
};

/// Flies the episode of a seed with the policy that ReadChoice returned. The search for the optimum ends
/// early if the program is asked to stop.
FlownPolicy FlyPolicy(const PolicyChoice& choice, const ChosenPolicy& chosen, uint64_t seed = 0);

/// Returns the name of the best flight that a search found: "exact optimum" only if that is proved.
std::string FoundFlightName(bool proved);

/// Returns the name of the episode: the policy as it was named on the command line, or FoundFlightName if the
/// search for the optimum ended before the proof.
std::string EpisodeName(const FlownPolicy& flown, const std::string& policy);

/// Describes the episode with the world's own words: "aoi: arrived; average AoI 17.543 slots, total AoI 3684,
/// 14211 J left".
std::string EpisodeSummary(const FlownPolicy& flown, const std::string& policy);

/// Searches for the exact optimum until it is proved, a limit is reached or the program is asked to stop.
/// Returns the best flight found. CHECKs CanPlan.
Plan PlanWithin(const World& world, uint64_t seed, const PlannerLimits& limits);

}  // namespace fresco
