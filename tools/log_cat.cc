#include <memory>

#include "logs/event_input.h"
#include "logs/event_json.h"
#include "logs/event_source.h"
#include "logs/text_output.h"
#include "tools/log_commands.h"

namespace fresco {
namespace {

int Cat(const EventInputOptions& options) {
  TextOutput output;
  MessageDecoder decoder;
  const bool live = IsLcmUrl(options.sources.front());
  EventInput(options).ForEach([&](const LcmEvent& event) {
    output.Write(EventJson(event, decoder) + "\n");
    if (live) {
      output.Flush();
    }
  });
  output.Flush();
  return 0;
}

}  // namespace

void AddLogCat(CLI::App& log, Command& command) {
  auto options = std::make_shared<EventInputOptions>();
  CLI::App* cat = log.add_subcommand("cat", "Print each event, decoded, as a line of JSON");
  AddEventInput(*cat, *options);
  cat->callback([options, &command] { command = [options] { return Cat(*options); }; });
}

}  // namespace fresco
