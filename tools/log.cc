// The subcommand `fresco log`, and those of its subcommands that read events and print or copy them.
#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "core/help_formatter.h"
#include "logs/event_input.h"
#include "logs/event_log_writer.h"
#include "logs/exported_messages.h"
#include "logs/log_repair.h"
#include "logs/log_summary.h"
#include "logs/row_writer.h"
#include "msgs/message_decoder.h"
#include "tools/subcommands.h"

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

void AddInfo(CLI::App& log, Command& command) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* info = log.add_subcommand("info", "Show what logs contain: channels, runs, actors, gaps, damage");
  AddEventInput(*info, options->input);
  info->add_option("--format", options->format, "How the result is printed")->check(OneOf({"text", "json"}));
  info->footer(HelpExamples(
      {"fresco log info run.lcm", "fresco log info 'udpm://239.255.76.67:7667?ttl=0' --seconds 5"}));
  info->callback([options, &command] { command = [options] { return Info(*options); }; });
}

int Cat(const EventInputOptions& options) {
  TextOutput output;
  MessageDecoder decoder;
  WorldNamesByRun names;
  EventInput input(options);
  input.ForEach([&](const LcmEvent& event) {
    names.Add(event);
    output.Write(EventJson(event, decoder, names) + "\n");
    if (input.is_live()) {
      output.Flush();
    }
  });
  output.Flush();
  return 0;
}

void AddCat(CLI::App& log, Command& command) {
  auto options = std::make_shared<EventInputOptions>();
  CLI::App* cat = log.add_subcommand("cat", "Print each event, decoded, as a line of JSON");
  AddEventInput(*cat, *options);
  cat->footer(HelpExamples({"fresco log cat run.lcm --channel FRESCO_ORDERS --stop 1"}));
  cat->callback([options, &command] { command = [options] { return Cat(*options); }; });
}

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

void AddCut(CLI::App& log, Command& command) {
  auto options = std::make_shared<CutOptions>();
  CLI::App* cut = log.add_subcommand("cut", "Copy some of the events to a new log: by time, channel or run");
  AddEventInput(*cut, options->input);
  cut->add_option("--out", options->out, "The new log; never written over")->type_name("FILE")->required();
  cut->add_option("--split-mb", options->split_mb,
                  "Split into files of so many megabytes: OUT.00, OUT.01, ..")
      ->check(CLI::Range(0.001, 1e9));
  cut->footer(HelpExamples({"fresco log cut run.lcm --out evening.lcm --start 3600 --stop 7200",
                            "fresco log cut run.lcm --out small.lcm --drop 'FRESCO_WEIGHTS_.*'"}));
  cut->callback([options, &command] { command = [options] { return Cut(*options); }; });
}

struct RepairOptions {
  std::string log;
  std::string out;
};

int Repair(const RepairOptions& options) {
  fmt::print("{}", RepairText(RepairLog(options.log, options.out), options.log, options.out));
  return 0;
}

void AddRepair(CLI::App& log, Command& command) {
  auto options = std::make_shared<RepairOptions>();
  CLI::App* repair =
      log.add_subcommand("repair", "Copy all sound events of a torn or damaged log to a new one");
  repair->add_option("LOG", options->log, "The damaged event log")->required();
  repair->add_option("--out", options->out, "The new log; never written over")->type_name("FILE")->required();
  repair->footer(HelpExamples({"fresco log repair torn.lcm --out sound.lcm"}));
  repair->callback([options, &command] { command = [options] { return Repair(*options); }; });
}

}  // namespace

void AddLog(CLI::App& app, Command& command) {
  CLI::App* log =
      app.add_subcommand("log", "Record, inspect, cut, repair, export and play logs of the traffic");
  log->require_subcommand(1);
  AddLogRecord(*log, command);
  AddInfo(*log, command);
  AddCat(*log, command);
  AddCut(*log, command);
  AddRepair(*log, command);
  AddLogExport(*log, command);
  AddLogPlay(*log, command);
}

}  // namespace fresco
