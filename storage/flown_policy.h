// What a person names on the command line to be flown greedily, and the flight that comes of it. Used by one
// thread.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "msgs/experiment.h"
#include "storage/policy.h"

namespace fresco {

struct PolicyChoice {
  std::string config;                 ///< empty: that of the trained policy, or quick.textproto
  std::vector<std::string> settings;  ///< path=value, on top of it
  std::string policy;
  PlannerLimits limits;
};

/// --config, --set, --policy, --time-limit-s, --memory-limit-mb. `choice` must outlive the parsing.
void AddPolicyOptions(CLI::App& app, PolicyChoice& choice);

/// A policy and the world that it is to fly in, read and checked.
struct ChosenPolicy {
  Experiment experiment;
  std::optional<StoredNetwork> network;  ///< none: a baseline or the optimum
};

/// Throws UsageError if policy and configuration do not name one.
ChosenPolicy ReadChoice(const PolicyChoice& choice);

/// What was flown, and in which world.
struct FlownPolicy {
  explicit FlownPolicy(const Experiment& given) : experiment(given), world(given.scenario()) {}
  Experiment experiment;
  World world;
  Flight flight;
  std::optional<Plan> plan;  ///< of the policy "optimal"
};

/// Flies one episode of what ReadChoice has read. The search for the optimum ends early if the program is
/// asked to stop.
FlownPolicy FlyPolicy(const PolicyChoice& choice, const ChosenPolicy& chosen);

/// What the best flight that a search found is called: the exact optimum only if it is proved.
std::string FoundFlightName(bool proved);

/// What the flight is called: the policy that was named, or what it is if the search for the optimum was
/// ended before the proof.
std::string FlightName(const FlownPolicy& flown, const std::string& policy);

/// "aoi: arrived; average AoI 17.543 slots, total AoI 3684, 14211 J left".
std::string FlightSummary(const FlownPolicy& flown, const std::string& policy);

}  // namespace fresco
