#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <type_traits>

#include "logs/event_input.h"
#include "logs/row_writer.h"
#include "msgs/message_decoder.h"
#include "tools/log_commands.h"

namespace fresco {
namespace {

struct ExportOptions {
  EventInputOptions input;
  std::string what = "transitions";
  std::string format = "csv";
  std::string out;
};

class Exporter {
 public:
  Exporter(const std::string& what, RowWriter& writer) : what_(what), writer_(writer) {}

  void Take(const LcmEvent& event) {
    const auto result = decoder_.Decode(event.message, [this](const auto& message) { Export(message); });
    damaged_ += result == MessageDecoder::Result::kDamaged ? 1 : 0;
  }
  int64_t damaged() const { return damaged_; }

 private:
  template <class Message>
  void Export(const Message& message) {
    const auto write = [this](const NamedRow& row) { writer_.Write(row); };
    if constexpr (std::is_same_v<Message, transitions_t>) {
      if (what_ == "transitions" && !ForEachTransitionRow(message, write)) {
        ++damaged_;
      }
    } else if constexpr (std::is_same_v<Message, actor_status_t>) {
      if (what_ == "actor-statuses") {
        write(StatusRow(message));
      }
    } else if constexpr (std::is_same_v<Message, learner_status_t>) {
      if (what_ == "learner-statuses") {
        write(StatusRow(message));
      }
    }
  }

  const std::string& what_;
  RowWriter& writer_;
  MessageDecoder decoder_;
  int64_t damaged_ = 0;
};

int Export(const ExportOptions& options) {
  EventInput input(options.input);  // checks the options before the table is overwritten
  TextOutput output(options.out);
  RowWriter writer(output, options.format == "csv" ? RowWriter::Format::kCsv : RowWriter::Format::kJsonLines);
  Exporter exporter(options.what, writer);
  input.ForEach([&](const LcmEvent& event) { exporter.Take(event); });
  output.Flush();
  if (exporter.damaged() > 0) {
    spdlog::warn("{} messages are damaged and were left out", exporter.damaged());
  }
  if (!options.out.empty()) {
    fmt::print("{}: {} rows\n", options.out, writer.rows());
  }
  return 0;
}

}  // namespace

void AddLogExport(CLI::App& log, Command& command) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App* app = log.add_subcommand("export", "Write transitions or statuses as a table");
  AddEventInput(*app, options->input);
  app->add_option("--what", options->what, "transitions, actor-statuses or learner-statuses")
      ->capture_default_str()
      ->check(OneOf({"transitions", "actor-statuses", "learner-statuses"}));
  app->add_option("--format", options->format, "csv or jsonl")
      ->capture_default_str()
      ->check(OneOf({"csv", "jsonl"}));
  app->add_option("--out", options->out, "The table's file; default: standard output");
  app->callback([options, &command] { command = [options] { return Export(*options); }; });
}

}  // namespace fresco
