#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "logs/event_input.h"
#include "logs/log_summary_text.h"
#include "tools/log_commands.h"

namespace fresco {
namespace {

struct InfoOptions {
  EventInputOptions input;
  std::string format = "text";
};

int Info(const InfoOptions& options) {
  LogSummary summary;
  const auto totals = EventInput(options.input).ForEach([&](const LcmEvent& event) { summary.Take(event); });
  fmt::print("{}", options.format == "json" ? LogSummaryJson(summary, totals) + "\n"
                                            : LogSummaryText(summary, totals));
  std::fflush(stdout);
  return 0;
}

}  // namespace

void AddLogInfo(CLI::App& log, Command& command) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* info = log.add_subcommand("info", "Show what logs contain: channels, runs, actors, gaps, damage");
  AddEventInput(*info, options->input);
  info->add_option("--format", options->format, "text or json")->check(OneOf({"text", "json"}));
  info->callback([options, &command] { command = [options] { return Info(*options); }; });
}

}  // namespace fresco
