#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <optional>

#include "core/error.h"
#include "core/stop_signal.h"
#include "msgs/settings.h"
#include "tools/flight_json.h"
#include "tools/installation.h"
#include "tools/policy.h"
#include "tools/subcommands.h"

namespace fresco {
namespace {

struct EvaluateOptions {
  std::string config;
  std::vector<std::string> settings;
  std::string policy;
  PlannerLimits limits;
  std::string format = "text";
};

/// What was flown, and in which scenario.
struct Evaluated {
  explicit Evaluated(const Experiment& experiment) : world(experiment.scenario()) {}
  World world;
  Flight flight;
  std::optional<Plan> plan;  // of the policy "optimal"
};

Experiment GivenExperiment(const EvaluateOptions& options) {
  return Experiment::Load(options.config.empty() ? DefaultConfigPath() : options.config,
                          ParseSettings(options.settings));
}

/// The scenario comes from --config; the network's shape and masks from the network's own
/// configuration, which --config replaces where it is given.
Experiment ExperimentOfNetwork(const EvaluateOptions& options, const StoredNetwork& network) {
  if (options.config.empty()) {
    return Experiment::Parse(network.experiment.Text(), options.policy, ParseSettings(options.settings));
  }
  Experiment given = GivenExperiment(options);
  if (given.network_shape().layer_sizes() != network.experiment.network_shape().layer_sizes()) {
    throw UsageError(fmt::format("{}: its network (sensors, hidden layers) is not that of {}", options.config,
                                 options.policy));
  }
  return given;
}

Evaluated FlyPolicy(const EvaluateOptions& options) {
  if (options.policy == "aoi" || options.policy == "distance") {
    Evaluated evaluated(GivenExperiment(options));
    evaluated.flight =
        FlyBaseline(evaluated.world, options.policy == "aoi" ? BaselineKind::kAoi : BaselineKind::kDistance);
    return evaluated;
  }
  if (options.policy == "optimal") {
    Evaluated evaluated(GivenExperiment(options));
    evaluated.plan = PlanWithin(evaluated.world, options.limits);
    evaluated.flight = evaluated.plan->flight;
    return evaluated;
  }
  const StoredNetwork network = ReadPolicy(options.policy);
  const Experiment experiment = ExperimentOfNetwork(options, network);
  Evaluated evaluated(experiment);
  evaluated.flight = FlyNetwork(evaluated.world, experiment, network);
  return evaluated;
}

void PrintText(const World& world, const Flight& flight, const std::string& policy) {
  const AoiFigures figures = Figures(world, flight);
  fmt::print("slot  cell      move   scheduled  AoI\n");
  for (const FlightSlot& slot : flight.slots) {
    const std::string cell = fmt::format("({},{})", slot.state.cell.column, slot.state.cell.row);
    fmt::print("{:>4}  {:<8}  {:<5}  {:>9}  {}\n", slot.state.slot, cell, MoveName(slot.action.move),
               slot.action.schedule == 0 ? "-" : std::to_string(slot.action.schedule),
               fmt::join(slot.state.aoi, " "));
  }
  fmt::print("\n{}: {}; average AoI {:.3f} slots, total AoI {}, {:.0f} J left\n", policy,
             OutcomeName(flight.outcome), figures.average_aoi, figures.total_aoi, flight.residual_energy_j);
}

void PrintProof(const Plan& plan) {
  if (plan.optimal) {
    fmt::print("This is the exact optimum: no flight has a smaller average AoI.\n");
  } else {
    const double average_aoi = plan.lower_bound_average_aoi;
    fmt::print("The search was ended early: no flight has an average AoI below {:.3f} (total AoI {:.1f}).\n",
               average_aoi, plan.lower_bound_total_aoi);
  }
}

int Evaluate(const EvaluateOptions& options) {
  const Evaluated evaluated = FlyPolicy(options);
  if (options.format == "json") {
    fmt::print("{}\n", FlightJson(evaluated.world, evaluated.flight, options.policy, evaluated.plan));
    return StopSignal::Requested() ? 1 : 0;
  }
  PrintText(evaluated.world, evaluated.flight, options.policy);
  if (evaluated.plan) {
    PrintProof(*evaluated.plan);
  }
  return StopSignal::Requested() ? 1 : 0;
}

}  // namespace

void AddEvaluate(CLI::App& app, Command& command) {
  auto options = std::make_shared<EvaluateOptions>();
  CLI::App* evaluate = app.add_subcommand("evaluate", "Fly one episode greedily and show it slot by slot");
  evaluate->add_option("--config", options->config,
                       "Experiment; default: that of the trained policy, or quick.textproto");
  evaluate->add_option("--set", options->settings, "Override one field: path=value; may be repeated");
  evaluate
      ->add_option("--policy", options->policy,
                   "aoi, distance, optimal, a run's folder, a network file or a checkpoint")
      ->required();
  evaluate
      ->add_option("--time-limit-s", options->limits.seconds,
                   "optimal: end the search after so many seconds with what is proved; default: none")
      ->check(CLI::Range(0.001, 1e6));
  evaluate
      ->add_option_function<int64_t>(
          "--memory-limit-mb",
          [options](int64_t megabytes) { options->limits.memory_bytes = megabytes * 1'000'000; },
          "optimal: memory of the search; default: 2684")
      ->check(CLI::Range(1, 1'000'000));
  evaluate->add_option("--format", options->format, "text or json")->check(CLI::IsMember({"text", "json"}));
  options->limits.show_progress = true;
  evaluate->callback([options, &command] { command = [options] { return Evaluate(*options); }; });
}

}  // namespace fresco
