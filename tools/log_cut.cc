#include <fmt/format.h>

#include <memory>

#include "logs/event_input.h"
#include "logs/event_log_writer.h"
#include "tools/log_commands.h"

namespace fresco {
namespace {

struct CutOptions {
  EventInputOptions input;
  std::string out;
  double split_mb = 0;
};

int Cut(const CutOptions& options) {
  EventInput input(options.input);  // checks the options before the new log is made
  EventLogWriter writer(options.out, static_cast<int64_t>(1e6 * options.split_mb));
  input.ForEach([&](const LcmEvent& event) { writer.Write(event); });
  writer.Flush();
  fmt::print("{}: {} events, {:.1f} MB\n", options.out, writer.events(),
             1e-6 * static_cast<double>(writer.bytes()));
  return 0;
}

}  // namespace

void AddLogCut(CLI::App& log, Command& command) {
  auto options = std::make_shared<CutOptions>();
  CLI::App* cut = log.add_subcommand("cut", "Copy some of the events to a new log: by time, channel or run");
  AddEventInput(*cut, options->input);
  cut->add_option("--out", options->out, "The new log; never written over")->required();
  cut->add_option("--split-mb", options->split_mb,
                  "Split into files of so many megabytes: OUT.00, OUT.01, ..")
      ->check(CLI::Range(0.001, 1e9));
  cut->callback([options, &command] { command = [options] { return Cut(*options); }; });
}

}  // namespace fresco
