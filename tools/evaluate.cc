#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <optional>

#include "actors/flyer.h"
#include "core/error.h"
#include "msgs/network_file.h"
#include "msgs/settings.h"
#include "tools/flight_json.h"
#include "tools/installation.h"
#include "tools/subcommands.h"

namespace fresco {
namespace {

struct EvaluateOptions {
  std::string config;
  std::vector<std::string> settings;
  std::string policy;
  std::string format = "text";
};

/// The best network of a run's folder, or the file itself.
std::filesystem::path NetworkPath(const std::string& policy) {
  const std::filesystem::path path(policy);
  if (!std::filesystem::exists(path)) {
    throw UsageError(fmt::format(
        "--policy: expected aoi, distance, a run's folder or a network file; \"{}\" is none of them",
        policy));
  }
  return std::filesystem::is_directory(path) ? path / "best.network" : path;
}

Flight FlyNetwork(const World& world, const Experiment& experiment, const StoredNetwork& network) {
  if (network.experiment.network_shape().inputs() != world.inputs()) {
    throw UsageError(fmt::format("--policy: the network was trained for {} sensors, the scenario has {}",
                                 network.experiment.network_shape().inputs() - 4, world.sensors()));
  }
  const Episode episode = FlyGreedily(world, experiment, std::make_shared<const Vector>(network.parameters));
  size_t next = 0;
  return Fly(world, [&](const Environment&) { return world.ActionAt(episode.actions[next++]); });
}

/// The scenario comes from --config; the network's shape and masks from the network's own
/// configuration, which --config replaces where it is given.
Flight FlyPolicy(const EvaluateOptions& options, std::optional<Experiment>& experiment) {
  const bool baseline = options.policy == "aoi" || options.policy == "distance";
  std::optional<StoredNetwork> network;
  if (!baseline) {
    network = ReadNetworkFile(NetworkPath(options.policy));
    experiment =
        Experiment::Parse(network->experiment.Text(), options.policy, ParseSettings(options.settings));
  }
  if (baseline || !options.config.empty()) {
    const std::string config = options.config.empty() ? DefaultConfigPath() : options.config;
    Experiment given = Experiment::Load(config, ParseSettings(options.settings));
    if (network && given.network_shape().layer_sizes() != network->experiment.network_shape().layer_sizes()) {
      throw UsageError(
          fmt::format("{}: its network (sensors, hidden layers) is not that of {}", config, options.policy));
    }
    experiment = std::move(given);
  }
  const World world(experiment->scenario());
  return baseline ? FlyBaseline(world, options.policy == "aoi" ? BaselineKind::kAoi : BaselineKind::kDistance)
                  : FlyNetwork(world, *experiment, *network);
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

int Evaluate(const EvaluateOptions& options) {
  std::optional<Experiment> experiment;
  const Flight flight = FlyPolicy(options, experiment);
  const World world(experiment->scenario());
  if (options.format == "json") {
    fmt::print("{}\n", FlightJson(world, flight, options.policy));
  } else {
    PrintText(world, flight, options.policy);
  }
  return 0;
}

}  // namespace

void AddEvaluate(CLI::App& app, Command& command) {
  auto options = std::make_shared<EvaluateOptions>();
  CLI::App* evaluate = app.add_subcommand("evaluate", "Fly one episode greedily and show it slot by slot");
  evaluate->add_option("--config", options->config,
                       "Experiment; default: that of the trained policy, or quick.textproto");
  evaluate->add_option("--set", options->settings, "Override one field: path=value; may be repeated");
  evaluate->add_option("--policy", options->policy, "aoi, distance, a run's folder or a network file")
      ->required();
  evaluate->add_option("--format", options->format, "text or json")->check(CLI::IsMember({"text", "json"}));
  evaluate->callback([options, &command] { command = [options] { return Evaluate(*options); }; });
}

}  // namespace fresco
