// The subcommand `fresco log`, and those of its subcommands that read events and print or copy them.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <map>
#include <memory>
#include <type_traits>

#include "logs/event_input.h"
#include "logs/event_log_writer.h"
#include "logs/exported_messages.h"
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
  cut->callback([options, &command] { command = [options] { return Cut(*options); }; });
}

struct ExportOptions {
  EventInputOptions input;
  std::string what = "transitions";
  std::string format = "csv";
  std::string out;
};

/// Writes the rows of the chosen kind of messages to a table.
class Exporter {
 public:
  Exporter(const ExportOptions& options, RowWriter& writer) : what_(options.what), writer_(writer) {}

  WorldNamesByRun& names() { return names_; }
  /// Whether transitions wait for their names. A log was searched for names before; from a bus they come.
  void WaitForNames() { waits_for_names_ = true; }
  int64_t damaged() const { return damaged_; }
  int64_t unnamed() const { return unnamed_; }

  void Write(const LcmEvent& event) {
    bool sound = true;
    const auto result = decoder_.Decode(event.message, [&](const auto& message) { sound = Export(message); });
    damaged_ += sound && result != MessageDecoder::Result::kDamaged ? 0 : 1;
  }

 private:
  /// Returns false if the message is damaged.
  template <class Message>
  bool Export(const Message& message) {
    if constexpr (std::is_same_v<Message, transitions_t>) {
      if (what_ != "transitions") {
        return true;
      }
      const WorldNames* names = names_.Of(message.run_id);
      if (names == nullptr && waits_for_names_) {
        ++unnamed_;
        return true;
      }
      return ForEachTransitionRow(message, names, [&](const NamedRow& row) { writer_.Write(row); });
    } else if constexpr (std::is_same_v<Message, actor_status_t> ||
                         std::is_same_v<Message, learner_status_t>) {
      if (what_ == (std::is_same_v<Message, actor_status_t> ? "actor-statuses" : "learner-statuses")) {
        writer_.Write(StatusRow(message));
      }
    }
    return true;
  }

  std::string what_;
  RowWriter& writer_;
  WorldNamesByRun names_;
  MessageDecoder decoder_;
  bool waits_for_names_ = false;
  int64_t damaged_ = 0;
  int64_t unnamed_ = 0;
};

int Export(const ExportOptions& options) {
  EventInput input(options.input);  // checks the options before the table is overwritten
  TextOutput output(options.out);
  RowWriter writer(output, options.format == "csv" ? RowWriter::Format::kCsv : RowWriter::Format::kJsonLines);
  Exporter exporter(options, writer);
  if (input.is_live()) {
    exporter.WaitForNames();
  } else if (options.what == "transitions") {
    EventInputOptions everything = options.input;
    everything.selection = {};
    EventInput(everything).ForEach([&](const LcmEvent& event) { exporter.names().Add(event); });
  }
  input.ForEach([&](const LcmEvent& event) {
    if (input.is_live()) {
      exporter.names().Add(event);
    }
    exporter.Write(event);
  });
  output.Flush();
  if (exporter.damaged() > 0) {
    spdlog::warn("{} messages are damaged and were left out", exporter.damaged());
  }
  if (exporter.unnamed() > 0) {
    spdlog::warn("{} messages came before the names of their fields (FRESCO_WORLD) and were left out",
                 exporter.unnamed());
  }
  if (!options.out.empty()) {
    fmt::print("{}: {} rows\n", options.out, writer.rows());
  }
  return 0;
}

void AddLogExport(CLI::App& log, Command& command) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App* app = log.add_subcommand("export", "Write transitions or statuses as a table");
  AddEventInput(*app, options->input);
  app->add_option("--what", options->what, "transitions, actor-statuses or learner-statuses")
      ->capture_default_str()
      ->check(OneOf({"transitions", "actor-statuses", "learner-statuses"}));
  app->add_option("--format", options->format, "How the rows are written")
      ->capture_default_str()
      ->check(OneOf({"csv", "jsonl"}));
  app->add_option("--out", options->out, "The table's file; default: standard output")->type_name("FILE");
  app->callback([options, &command] { command = [options] { return Export(*options); }; });
}

}  // namespace

void AddLog(CLI::App& app, Command& command) {
  CLI::App* log = app.add_subcommand("log", "Record, inspect, cut, export and play logs of the traffic");
  log->require_subcommand(1);
  AddLogRecord(*log, command);
  AddInfo(*log, command);
  AddCat(*log, command);
  AddCut(*log, command);
  AddLogExport(*log, command);
  AddLogPlay(*log, command);
}

}  // namespace fresco
