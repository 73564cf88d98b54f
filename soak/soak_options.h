// What `fresco soak` is asked to do, and what follows from it for its runs.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bus/authentication_key.h"
#include "msgs/experiment.h"

namespace fresco {

struct SoakOptions {
  double minutes = 5;
  std::string config;
  std::vector<std::string> settings;
  std::optional<int> actors;
  uint64_t seed = 1;
  int first_round = 1;
  int rounds = 0;  ///< 0: as many as the time is good for
  std::string out;
  std::string lcm_url;
  KeyFile key_file;  ///< of every round
  int memory_allowance_mib = 8;
  std::string format = "text";
};

/// The options of the command line. `options` must outlive the parsing.
void AddSoakOptions(CLI::App& soak, SoakOptions& options);

/// What a soak asks of a run, before --set: some seconds of training, nothing beside it, and checkpoints
/// often enough that a killed learner has little to do again. Throws UsageError where there is no actor to
/// kill.
Experiment SoakExperiment(const SoakOptions& options);

/// The command that has the round again.
std::string RepeatCommand(const SoakOptions& options, int round);

}  // namespace fresco
