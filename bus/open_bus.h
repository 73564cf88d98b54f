// Opens the bus of a program: LCM, wrapped as the command line says. The options are the same in every
// program. They are not part of an experiment's configuration, since that is sent to everybody. Any thread
// may call these functions.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "bus/authenticated_bus.h"
#include "bus/bus.h"
#include "bus/lossy_bus.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace fresco {

struct BusOptions {
  KeyFile key_file = {};                        ///< if set, messages are authenticated with this key
  std::optional<LossOptions> disturbance = {};  ///< if set, sent messages are disturbed; for tests and soak
                                                ///< runs
};

/// Adds --key-file, whose value parsing writes to `key_file`. Returns the option.
CLI::Option* AddKeyFileOption(CLI::App& app, KeyFile& key_file);

/// Adds --key-file and --disturb, whose values parsing writes to `options`.
void AddBusOptions(CLI::App& app, BusOptions& options);

/// Opens the bus. Throws UsageError as OpenLcmBus does, and if the key file can't be
/// used.
std::unique_ptr<Bus> OpenBus(const std::string& url, const BusOptions& options);

}  // namespace fresco
