#include "bus/open_bus.h"

#include <CLI/CLI.hpp>
#include <utility>

namespace fresco {

CLI::Option* AddKeyFileOption(CLI::App& app, KeyFile& key_file) {
  return app
      .add_option_function<std::string>(
          "--key-file", [&key_file](const std::string& file) { key_file = file; },
          "File with the run's key: accept only messages that are authenticated with it")
      ->type_name("FILE");
}

void AddBusOptions(CLI::App& app, BusOptions& options) {
  AddKeyFileOption(app, options.key_file);
  app.add_option_function<std::string>(
         "--disturb", [&options](const std::string& text) { options.disturbance = ParseLossOptions(text); },
         "For tests: lose, repeat, delay and corrupt sent messages, e.g. drop=0.01,delay=0.05,seed=3")
      ->type_name("FAULTS");
}

std::unique_ptr<Bus> OpenBus(const std::string& url, const BusOptions& options) {
  std::optional<AuthenticationKey> key;
  if (options.key_file) {
    key = ReadAuthenticationKey(*options.key_file);  // before anything is received
  }
  std::unique_ptr<Bus> bus = OpenLcmBus(url);
  if (options.disturbance) {
    bus = MakeLossyBus(std::move(bus), *options.disturbance);
  }
  return key ? MakeAuthenticatedBus(std::move(bus), *key) : std::move(bus);
}

}  // namespace fresco
