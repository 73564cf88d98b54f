// Adds the command line options that concern the bus. They are the same in every program.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "bus/open_bus.h"

namespace fresco {

/// Adds --key-file, whose value parsing writes to `key_file`.
inline void AddKeyFileOption(CLI::App& app, KeyFile& key_file) {
  app.add_option_function<std::string>(
      "--key-file", [&key_file](const std::string& file) { key_file = file; },
      "File with the run's key: accept only messages that are authenticated with it");
}

/// Adds --key-file and --disturb, whose values parsing writes to `options`.
inline void AddBusOptions(CLI::App& app, BusOptions& options) {
  AddKeyFileOption(app, options.key_file);
  app.add_option_function<std::string>(
      "--disturb", [&options](const std::string& text) { options.disturbance = ParseLossOptions(text); },
      "For tests: lose, repeat, delay and corrupt sent messages, e.g. drop=0.01,delay=0.05,seed=3");
}

}  // namespace fresco
