#include "storage/flown_policy.h"

#include <fmt/format.h>

#include "core/error.h"
#include "msgs/ready_experiments.h"
#include "msgs/settings.h"
#include "worlds/uav/baselines.h"

namespace fresco {
namespace {

Experiment GivenExperiment(const PolicyChoice& choice) {
  return Experiment::Load(ExperimentPath(choice.config.empty() ? kDefaultExperiment : choice.config),
                          ParseSettings(choice.settings));
}

/// Returns the experiment to fly in: that of --config if it is given, otherwise that of the network. Throws
/// UsageError if the network does not fit it.
Experiment ExperimentOfNetwork(const PolicyChoice& choice, const StoredNetwork& network) {
  if (choice.config.empty()) {
    return Experiment::Parse(network.experiment.Text(), choice.policy, ParseSettings(choice.settings));
  }
  Experiment given = GivenExperiment(choice);
  if (given.network_shape().layer_sizes() != network.experiment.network_shape().layer_sizes()) {
    throw UsageError(fmt::format("{}: its network (sensors, hidden layers) is not that of {}", choice.config,
                                 choice.policy));
  }
  return given;
}

}  // namespace

void AddPolicyOptions(CLI::App& app, PolicyChoice& choice) {
  app.add_option("--config", choice.config,
                 ConfigHelp(std::string("the one of the trained policy, or ") + kDefaultExperiment));
  app.add_option("--set", choice.settings, "Override one field: path=value; may be repeated");
  app.add_option("--policy", choice.policy, kPolicyKinds)->required();
  app.add_option("--time-limit-s", choice.limits.seconds,
                 "For the policy optimal: stop the search after so many seconds; default: no limit")
      ->check(CLI::Range(0.001, 1e6));
  app.add_option_function<int64_t>(
         "--memory-limit-mb",
         [&choice](int64_t megabytes) { choice.limits.memory_bytes = megabytes * 1'000'000; },
         "For the policy optimal: memory that the search may take; default: 2684")
      ->check(CLI::Range(1, 1'000'000));
}

ChosenPolicy ReadChoice(const PolicyChoice& choice) {
  if (IsBuiltInPolicy(choice.policy)) {
    return {GivenExperiment(choice), std::nullopt};
  }
  StoredNetwork network = ReadPolicy(choice.policy);
  Experiment experiment = ExperimentOfNetwork(choice, network);
  return {std::move(experiment), std::move(network)};
}

FlownPolicy FlyPolicy(const PolicyChoice& choice, const ChosenPolicy& chosen) {
  FlownPolicy flown(chosen.experiment);
  if (chosen.network) {
    flown.flight = FlyNetwork(flown.world, flown.experiment, *chosen.network);
  } else if (choice.policy == kOptimalPolicy) {
    flown.plan = PlanWithin(flown.world, choice.limits);
    flown.flight = flown.plan->flight;
  } else {
    flown.flight =
        FlyBaseline(flown.world, choice.policy == kAoiPolicy ? BaselineKind::kAoi : BaselineKind::kDistance);
  }
  return flown;
}

std::string FoundFlightName(bool proved) {
  return proved ? "exact optimum" : "best flight of the search";
}

std::string FlightName(const FlownPolicy& flown, const std::string& policy) {
  return flown.plan && !flown.plan->optimal ? FoundFlightName(false) : policy;
}

std::string FlightSummary(const FlownPolicy& flown, const std::string& policy) {
  const AoiFigures figures = Figures(flown.world, flown.flight);
  return fmt::format("{}: {}; average AoI {:.3f} slots, total AoI {}, {:.0f} J left",
                     FlightName(flown, policy), OutcomeName(flown.flight.outcome), figures.average_aoi,
                     figures.total_aoi, ResidualEnergy(flown.world, flown.flight));
}

}  // namespace fresco
