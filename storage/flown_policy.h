// Reads from the command line which policy to fly in which world, and flies it greedily. For `evaluate` and
// `fly`. Only one thread may use it.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "msgs/experiment.h"
#include "storage/policy.h"

namespace fresco {

/// The values of the command line options.
struct PolicyChoice {
  std::string config;                 ///< empty: the configuration of the trained policy, or
                                      ///< kDefaultExperiment
  std::vector<std::string> settings;  ///< path=value, applied to the configuration
  std::string policy;
  PlannerLimits limits;
};

/// Adds --config, --set, --policy, --time-limit-s and --memory-limit-mb, whose values parsing writes to
/// `choice`.
void AddPolicyOptions(CLI::App& app, PolicyChoice& choice);

/// A policy and the experiment in whose world it flies, read and checked.
struct ChosenPolicy {
  Experiment experiment;
  std::optional<StoredNetwork> network;  ///< none if the policy is a baseline or the optimum
};

/// Reads the files that the choice names. Throws UsageError if they can't be used or do not fit together.
ChosenPolicy ReadChoice(const PolicyChoice& choice);

/// A flight, its world, and the experiment that defines the world.
struct FlownPolicy {
  explicit FlownPolicy(const Experiment& given) : experiment(given), world(given.scenario()) {}
  Experiment experiment;
  World world;
  Episode flight;
  std::optional<Plan> plan;  ///< set if the policy is "optimal"
};

/// Flies one episode of the policy that ReadChoice returned. The search for the optimum ends early if the
/// program is asked to stop.
FlownPolicy FlyPolicy(const PolicyChoice& choice, const ChosenPolicy& chosen);

/// Returns the name of the best flight that a search found: "exact optimum" only if that is proved.
std::string FoundFlightName(bool proved);

/// Returns the name of the flight: the policy as it was named on the command line, or FoundFlightName if the
/// search for the optimum ended before the proof.
std::string FlightName(const FlownPolicy& flown, const std::string& policy);

/// Describes a flight: "aoi: arrived; average AoI 17.543 slots, total AoI 3684, 14211 J left".
std::string FlightSummary(const FlownPolicy& flown, const std::string& policy);

}  // namespace fresco
