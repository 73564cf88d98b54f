// The command line options of `fresco soak`, and the experiment that follows from them. Any thread may call
// these functions.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bus/authenticated_bus.h"
#include "msgs/experiment.h"

namespace fresco {

struct SoakOptions {
  double minutes = 5;
  std::string config;
  std::vector<std::string> settings;
  std::optional<int> actors;
  uint64_t seed = 1;
  int first_round = 1;
  int rounds = 0;  ///< the most rounds; 0: as many as fit into the time
  std::string out;
  std::string lcm_url;
  KeyFile key_file;  ///< for every round
  int memory_allowance_mib = 8;
  std::string format = "text";
};

/// Adds the options to the command line; parsing writes their values to `options`.
void AddSoakOptions(CLI::App& soak, SoakOptions& options);

/// Returns the experiment of every run. Without --set, it trains for some seconds, does not search for the
/// optimum, and takes checkpoints so often that a resumed learner repeats little. Throws UsageError if it has
/// no local actor.
Experiment SoakExperiment(const SoakOptions& options);

/// Returns the command that repeats this round.
std::string RepeatCommand(const SoakOptions& options, int round);

}  // namespace fresco
