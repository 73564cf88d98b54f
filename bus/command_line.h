// The options of a program's command line that say how it is on the bus: the same in every program.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "bus/open_bus.h"

namespace fresco {

/// --key-file. `key_file` must outlive the parsing.
inline void AddKeyFileOption(CLI::App& app, KeyFile& key_file) {
  app.add_option_function<std::string>(
      "--key-file", [&key_file](const std::string& file) { key_file = file; },
      "The run's key: take only messages that are authenticated with it");
}

/// --key-file and --disturb. `options` must outlive the parsing.
inline void AddBusOptions(CLI::App& app, BusOptions& options) {
  AddKeyFileOption(app, options.key_file);
  app.add_option_function<std::string>(
      "--disturb", [&options](const std::string& text) { options.disturbance = ParseLossOptions(text); },
      "For tests: lose, repeat, delay and corrupt what is sent, e.g. drop=0.01,delay=0.05,seed=3");
}

}  // namespace fresco
