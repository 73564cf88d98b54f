#include "tools/flown_policy.h"

#include <fmt/format.h>

#include "core/error.h"
#include "msgs/settings.h"
#include "tools/installation.h"

namespace fresco {
namespace {

Experiment GivenExperiment(const PolicyChoice& choice) {
  return Experiment::Load(choice.config.empty() ? DefaultConfigPath() : choice.config,
                          ParseSettings(choice.settings));
}

/// The scenario comes from --config; the network's shape and masks from the network's own
/// configuration, which --config replaces where it is given.
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
                 "Experiment; default: that of the trained policy, or quick.textproto");
  app.add_option("--set", choice.settings, "Override one field: path=value; may be repeated");
  app.add_option("--policy", choice.policy,
                 "aoi, distance, optimal, a run's folder, a network file or a checkpoint")
      ->required();
  app.add_option("--time-limit-s", choice.limits.seconds,
                 "optimal: end the search after so many seconds with what is proved; default: none")
      ->check(CLI::Range(0.001, 1e6));
  app.add_option_function<int64_t>(
         "--memory-limit-mb",
         [&choice](int64_t megabytes) { choice.limits.memory_bytes = megabytes * 1'000'000; },
         "optimal: memory of the search; default: 2684")
      ->check(CLI::Range(1, 1'000'000));
}

FlownPolicy FlyPolicy(const PolicyChoice& choice) {
  if (choice.policy == "aoi" || choice.policy == "distance") {
    FlownPolicy flown(GivenExperiment(choice));
    flown.flight =
        FlyBaseline(flown.world, choice.policy == "aoi" ? BaselineKind::kAoi : BaselineKind::kDistance);
    return flown;
  }
  if (choice.policy == "optimal") {
    FlownPolicy flown(GivenExperiment(choice));
    flown.plan = PlanWithin(flown.world, choice.limits);
    flown.flight = flown.plan->flight;
    return flown;
  }
  const StoredNetwork network = ReadPolicy(choice.policy);
  FlownPolicy flown(ExperimentOfNetwork(choice, network));
  flown.flight = FlyNetwork(flown.world, flown.experiment, network);
  return flown;
}

std::string FlightSummary(const World& world, const Flight& flight, const std::string& policy) {
  const AoiFigures figures = Figures(world, flight);
  return fmt::format("{}: {}; average AoI {:.3f} slots, total AoI {}, {:.0f} J left", policy,
                     OutcomeName(flight.outcome), figures.average_aoi, figures.total_aoi,
                     flight.residual_energy_j);
}

}  // namespace fresco
