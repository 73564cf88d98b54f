#include "soak/soak_options.h"

#include <fmt/format.h>

#include "bus/open_bus.h"
#include "core/command_line.h"
#include "core/error.h"
#include "core/installation.h"
#include "msgs/ready_experiments.h"
#include "msgs/settings.h"

namespace fresco {
namespace {

std::string QuotedForShell(const std::string& argument) {
  return "'" + argument + "'";
}

}  // namespace

void AddSoakOptions(CLI::App& soak, SoakOptions& options) {
  soak.add_option("--minutes", options.minutes, "How long to run; at least one round is run in any case")
      ->capture_default_str()
      ->check(CLI::Range(0.01, 1e5));
  soak.add_option("--config", options.config, ConfigHelp("ci with 2,000 episodes"));
  soak.add_option("--set", options.settings, "Override one field: path=value; may be repeated");
  soak.add_option("--actors", options.actors, "Local actor processes")->check(CLI::Range(1, 1024));
  soak.add_option("--seed", options.seed, "Seed of the faults")->capture_default_str();
  soak.add_option("--first-round", options.first_round, "Begin with this round's faults")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000'000));
  soak.add_option("--rounds", options.rounds, "The most rounds to run; default: as many as fit into the time")
      ->check(CLI::Range(1, 1'000'000'000));
  soak.add_option("--out", options.out, "New folder for the runs; default: one under runs/");
  soak.add_option("--lcm-url", options.lcm_url, "Where learner and actors meet");
  AddKeyFileOption(soak, options.key_file);
  soak.add_option("--memory-allowance-mib", options.memory_allowance_mib,
                  "Under faults, a program may need 1.25 times its memory without faults plus so much; the "
                  "soak itself may grow by twice as much over its rounds")
      ->capture_default_str()
      ->check(CLI::Range(0, 1 << 20));
  soak.add_option("--format", options.format, "text or json")->check(OneOf({"text", "json"}));
}

Experiment SoakExperiment(const SoakOptions& options) {
  Settings settings = {{"run.optimum_limit_s", "0"}, {"run.checkpoint_interval_s", "0.5"}};
  if (options.config.empty()) {
    settings.emplace_back("schedule.episodes", "2000");
  }
  const Settings given = ParseSettings(options.settings);
  settings.insert(settings.end(), given.begin(), given.end());
  if (options.actors) {
    settings.emplace_back("run.actors", std::to_string(*options.actors));
  }
  if (!options.lcm_url.empty()) {
    settings.emplace_back("run.lcm_url", options.lcm_url);
  }
  Experiment experiment =
      Experiment::Load(ExperimentPath(options.config.empty() ? "ci" : options.config), settings);
  if (experiment.run().actors() < 1) {
    throw UsageError("run.actors: a soak kills and stops its own actors; expected at least 1, found 0");
  }
  return experiment;
}

std::string RepeatCommand(const SoakOptions& options, int round) {
  std::string command =
      fmt::format("{} soak --seed {} --first-round {} --rounds 1", ProgramName(), options.seed, round);
  if (!options.config.empty()) {
    command += " --config " + QuotedForShell(options.config);
  }
  for (const std::string& setting : options.settings) {
    command += " --set " + QuotedForShell(setting);
  }
  if (options.actors) {
    command += fmt::format(" --actors {}", *options.actors);
  }
  if (!options.lcm_url.empty()) {
    command += " --lcm-url " + QuotedForShell(options.lcm_url);
  }
  if (options.key_file) {
    command += " --key-file " + QuotedForShell(options.key_file->string());
  }
  if (options.memory_allowance_mib != SoakOptions().memory_allowance_mib) {
    command += fmt::format(" --memory-allowance-mib {}", options.memory_allowance_mib);
  }
  return command;
}

}  // namespace fresco
