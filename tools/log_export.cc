// The subcommand `fresco log export`: messages of logs or of a live bus as tables or as an MCAP file.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <tuple>

#include "core/error.h"
#include "core/help_formatter.h"
#include "logs/event_input.h"
#include "logs/exported_messages.h"
#include "logs/mcap_writer.h"
#include "logs/protobuf_messages.h"
#include "logs/row_writer.h"
#include "msgs/message_decoder.h"
#include "tools/subcommands.h"

namespace fresco {
namespace {

struct ExportOptions {
  EventInputOptions input;
  std::string what;
  std::string format = "csv";
  std::string out;
};

const std::map<std::string, std::string> kTypeOf = {{"transitions", "transitions_t"},
                                                    {"actor-statuses", "actor_status_t"},
                                                    {"learner-statuses", "learner_status_t"}};

/// Whether all tables are wanted, in a folder, instead of one.
bool WantsFolder(const ExportOptions& options) {
  const std::string ending = std::filesystem::path(options.out).extension();
  return options.what.empty() && !options.out.empty() && ending != ".csv" && ending != ".jsonl";
}

/// What events are written to.
class ExportTarget {
 public:
  virtual ~ExportTarget() = default;
  /// Writes the event's message. What is damaged or foreign is not written.
  virtual MessageDecoder::Result Write(const LcmEvent& event, const WorldNamesByRun& names) = 0;
  /// Ends the output. Returns what it has, e.g. "12 rows".
  virtual std::string Finish() = 0;
};

class TableFile {
 public:
  TableFile(const std::string& path, RowWriter::Format format) : output_(path), rows_(output_, format) {}
  RowWriter& rows() { return rows_; }
  void Flush() { output_.Flush(); }

 private:
  TextOutput output_;
  RowWriter rows_;
};

RowWriter::Format TableFormat(const ExportOptions& options) {
  return options.format == "csv" ? RowWriter::Format::kCsv : RowWriter::Format::kJsonLines;
}

/// One table.
class OneTable : public ExportTarget {
 public:
  explicit OneTable(const ExportOptions& options) : table_(options.out, TableFormat(options)) {}

  MessageDecoder::Result Write(const LcmEvent& event, const WorldNamesByRun& names) override {
    return ForEachRow(event, decoder_, names, [this](const NamedRow& row) { table_.rows().Write(row); });
  }
  std::string Finish() override {
    table_.Flush();
    return fmt::format("{} rows", table_.rows().rows());
  }

 private:
  TableFile table_;
  MessageDecoder decoder_;
};

/// A folder with a table of each channel.
class TableFolder : public ExportTarget {
 public:
  explicit TableFolder(const ExportOptions& options)
      : folder_(options.out), format_(TableFormat(options)), ending_("." + options.format) {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (error) {
      throw UsageError(fmt::format("--out: can't make the folder {}: {}", options.out, error.message()));
    }
    if (!std::filesystem::is_empty(folder_)) {
      throw UsageError(fmt::format(
          "--out: expected a new or an empty folder for the tables; found files in {}", options.out));
    }
  }

  MessageDecoder::Result Write(const LcmEvent& event, const WorldNamesByRun& names) override {
    return ForEachRow(event, decoder_, names,
                      [&](const NamedRow& row) { TableOf(event.channel).rows().Write(row); });
  }

  std::string Finish() override {
    int64_t rows = 0;
    for (auto& [channel, table] : tables_) {
      table->Flush();
      rows += table->rows().rows();
    }
    return fmt::format("{} tables, {} rows", tables_.size(), rows);
  }

 private:
  TableFile& TableOf(std::string_view channel) {
    auto found = tables_.find(channel);
    if (found == tables_.end()) {
      auto table = std::make_unique<TableFile>(folder_ / (FileName(channel) + ending_), format_);
      found = tables_.emplace(channel, std::move(table)).first;
    }
    return *found->second;
  }

  /// A channel's name with %XX, as in URLs, for characters that a file's name should not have.
  static std::string FileName(std::string_view channel) {
    std::string name;
    for (const char c : channel) {
      const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                            c == '_' || c == '-' || (c == '.' && !name.empty());
      name += is_plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
    return name;
  }

  std::filesystem::path folder_;
  RowWriter::Format format_;
  std::string ending_;
  MessageDecoder decoder_;
  std::map<std::string, std::unique_ptr<TableFile>, std::less<>> tables_;  // by channel
};

class McapFile : public ExportTarget {
 public:
  explicit McapFile(const ExportOptions& options) : output_(options.out), writer_(output_) {}

  MessageDecoder::Result Write(const LcmEvent& event, const WorldNamesByRun& names) override {
    const auto result = ToProtobuf(event, decoder_, names, message_);
    if (result == MessageDecoder::Result::kDecoded) {
      writer_.Write(
          {ChannelOf(event), Nanoseconds(event.utime), Nanoseconds(message_.sent_utime), message_.bytes});
    }
    return result;
  }

  std::string Finish() override {
    writer_.Finish();
    return fmt::format("{} messages of {} channels", writer_.messages(), channels_.size());
  }

 private:
  static uint64_t Nanoseconds(int64_t utime) {
    return 1000 *
           static_cast<uint64_t>(std::clamp<int64_t>(utime, 0, std::numeric_limits<int64_t>::max() / 1000));
  }

  /// The file's channel for the message. An LCM channel has several only if messages of several types, or
  /// transitions of several worlds, are on it.
  uint16_t ChannelOf(const LcmEvent& event) {
    const std::tuple key(std::string(event.channel), message_.type, message_.names);
    const auto known = known_.find(key);
    if (known != known_.end()) {
      return known->second;
    }
    const McapSchema schema = {"fresco." + message_.type, "protobuf",
                               FileDescriptorSetOf(message_.type, message_.names)};
    const auto [found, is_new] = channels_.try_emplace({std::string(event.channel), schema.content}, 0);
    if (is_new) {
      found->second = writer_.AddChannel(Utf8Of(event.channel), schema);
    }
    return known_[key] = found->second;
  }

  TextOutput output_;
  McapWriter writer_;
  MessageDecoder decoder_;
  ProtobufMessage message_;
  std::map<std::pair<std::string, std::string>, uint16_t> channels_;  // by LCM channel and description
  std::map<std::tuple<std::string, std::string, const WorldNames*>, uint16_t> known_;
};

std::unique_ptr<ExportTarget> MakeTarget(const ExportOptions& options) {
  if (options.format == "mcap") {
    return std::make_unique<McapFile>(options);
  }
  if (WantsFolder(options)) {
    return std::make_unique<TableFolder>(options);
  }
  return std::make_unique<OneTable>(options);
}

/// Counts the events that are not exported, for the warnings at the end.
class LeftOut {
 public:
  void Count(const LcmEvent& event, MessageDecoder::Result result) {
    damaged_ += result == MessageDecoder::Result::kDamaged ? 1 : 0;
    if (result == MessageDecoder::Result::kForeign) {
      ++foreign_;
      if (foreign_channels_.size() < kMaximumNamed) {
        foreign_channels_.insert(Utf8Of(event.channel));
      }
    }
  }
  void CountUnnamed() { ++unnamed_; }

  void Warn() const {
    if (damaged_ > 0) {
      spdlog::warn("{} messages are damaged and were left out", damaged_);
    }
    if (foreign_ > 0) {
      spdlog::warn("{} events have messages of unknown types and were left out; their channels: {}{}",
                   foreign_, fmt::join(foreign_channels_, ", "),
                   foreign_channels_.size() == kMaximumNamed ? ", .. (fresco log info lists all)" : "");
    }
    if (unnamed_ > 0) {
      spdlog::warn("{} messages came before the names of their fields (FRESCO_WORLD) and were left out",
                   unnamed_);
    }
  }

 private:
  static constexpr size_t kMaximumNamed = 10;

  int64_t damaged_ = 0;
  int64_t foreign_ = 0;
  int64_t unnamed_ = 0;
  std::set<std::string> foreign_channels_;
};

/// Whether the event has transitions without known names. Logs are searched for names before; from a bus they
/// come.
bool IsUnnamed(const LcmEvent& event, const WorldNamesByRun& names) {
  return BeginsAs<transitions_t>(event.message) && PeekIdentity(event.message) &&
         names.Of(PeekIdentity(event.message)->run_id) == nullptr;
}

int Export(const ExportOptions& options) {
  const bool exports_all = options.format == "mcap" ? options.what.empty() : WantsFolder(options);
  const std::string only_type =
      exports_all ? "" : kTypeOf.at(options.what.empty() ? "transitions" : options.what);
  EventInput input(options.input);  // checks the options before anything is overwritten
  if (options.format == "mcap" && options.out.empty()) {
    throw UsageError("--format mcap: expected --out FILE");
  }
  const auto target = MakeTarget(options);
  WorldNamesByRun names;
  if (!input.is_live() && (exports_all || only_type == transitions_t::getTypeName())) {
    EventInputOptions everything = options.input;
    everything.selection = {};
    EventInput all_events(everything);
    while (const auto event = all_events.Next()) {
      names.Add(*event);
    }
  }
  LeftOut left_out;
  input.ForEach([&](const LcmEvent& event) {
    const char* type = PeekType(event.message);
    if (input.is_live()) {
      names.Add(event);
    }
    if (!exports_all && (type == nullptr || type != only_type)) {
      return;
    }
    if (input.is_live() && IsUnnamed(event, names)) {
      left_out.CountUnnamed();
    } else {
      left_out.Count(event, target->Write(event, names));
    }
  });
  const std::string content = target->Finish();
  left_out.Warn();
  if (!options.out.empty()) {
    fmt::print("{}: {}\n", options.out, content);
  }
  return 0;
}

}  // namespace

void AddLogExport(CLI::App& log, Command& command) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App* app = log.add_subcommand("export", "Write messages as tables or as an MCAP file");
  AddEventInput(*app, options->input);
  app->add_option("--what", options->what,
                  "Only these: transitions, actor-statuses or learner-statuses; default: all messages, or "
                  "transitions if there is one table")
      ->check(OneOf({"transitions", "actor-statuses", "learner-statuses"}));
  app->add_option("--format", options->format, "How they are written")
      ->capture_default_str()
      ->check(OneOf({"csv", "jsonl", "mcap"}));
  app->add_option(
         "--out", options->out,
         "A file NAME.csv or NAME.jsonl for one table, a folder for a table of each channel, or an MCAP "
         "file; default: one table, to standard output")
      ->type_name("PATH");
  app->footer(HelpExamples({"fresco log export run.lcm --format mcap --out run.mcap",
                            "fresco log export run.lcm --out tables",
                            "fresco log export run.lcm --out transitions.csv"}));
  app->callback([options, &command] { command = [options] { return Export(*options); }; });
}

}  // namespace fresco
