#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <limits>
#include <memory>

#include "core/clock.h"
#include "core/help_formatter.h"
#include "core/live_line.h"
#include "core/signals.h"
#include "logs/bus_losses.h"
#include "logs/recorder.h"
#include "tools/subcommands.h"

namespace fresco {
namespace {

struct RecordOptions {
  std::string out;
  double split_mb = 0;
  std::vector<std::string> channels;
  std::string lcm_url = kDefaultLcmUrl;
  double seconds = 0;
};

RecorderOptions RecorderOptionsFrom(const RecordOptions& options) {
  return {options.out, static_cast<int64_t>(options.split_mb * 1e6), {options.channels, "--channel"}};
}

std::string Text(const Recorder::Totals& totals) {
  return fmt::format("{} events, {:.1f} MB", totals.events, 1e-6 * static_cast<double>(totals.bytes));
}

std::string LossText(const Recorder::Totals& totals, const Bus& bus) {
  return (totals.dropped_events > 0 ? fmt::format(", {} DROPPED", totals.dropped_events) : "") +
         BusLossText(bus);
}

/// Warns once if events were dropped because the disk is too slow.
void WarnOfDrops(const Recorder::Totals& totals, bool& warned) {
  if (totals.dropped_events > 0 && !warned) {
    warned = true;
    spdlog::warn("the disk is too slow for this traffic: events are dropped, and the log is incomplete");
  }
}

int Record(const RecordOptions& options) {
  constexpr int64_t kPollUs = 100'000;
  const auto bus = OpenLcmBus(options.lcm_url);
  Recorder recorder(*bus, RecorderOptionsFrom(options));
  fmt::print("recording {} to {}\n", options.lcm_url, options.out);  // `fresco train` waits for this line
  std::fflush(stdout);
  const int64_t end_us = options.seconds > 0
                             ? MonotonicMicroseconds() + static_cast<int64_t>(1e6 * options.seconds)
                             : std::numeric_limits<int64_t>::max();
  LiveLine line(true);
  bool warned = false;
  while (!StopSignal::Requested() && MonotonicMicroseconds() < end_us) {
    recorder.Step(std::min(kPollUs, end_us - MonotonicMicroseconds()));
    WarnOfDrops(recorder.totals(), warned);
    line.Show(Text(recorder.totals()) + " recorded");
  }
  const Recorder::Totals totals = recorder.Finish();
  line.Finish();
  WarnOfDrops(totals, warned);
  WarnOfBusLosses(*bus);
  const std::string files = totals.files > 1 ? fmt::format(" in {} files", totals.files) : "";
  fmt::print("recorded: {}, {}{}{}\n", options.out, Text(totals), LossText(totals, *bus), files);
  return 0;
}

}  // namespace

void AddLogRecord(CLI::App& log, Command& command) {
  auto options = std::make_shared<RecordOptions>();
  CLI::App* record = log.add_subcommand("record", "Record all traffic, until Ctrl-C or for --seconds");
  record->add_option("--out", options->out, "The log; never written over")->type_name("FILE")->required();
  record
      ->add_option("--split-mb", options->split_mb,
                   "Split into files of so many megabytes: OUT.00, OUT.01, ..; default: one file")
      ->check(CLI::Range(0.001, 1e9));
  record
      ->add_option("--channel", options->channels,
                   "Only channels that match this regular expression; may be repeated")
      ->type_name("REGEX");
  record->add_option("--lcm-url", options->lcm_url, "LCM URL to listen to")
      ->type_name("URL")
      ->capture_default_str();
  record->add_option("--seconds", options->seconds, "How long to record; default: until Ctrl-C")
      ->check(CLI::Range(0.001, 1e9));
  record->footer(
      HelpExamples({"fresco log record --out run.lcm",
                    "fresco log record --out run.lcm --split-mb 100 --channel 'FRESCO_.*' --seconds 60"}));
  record->callback([options, &command] { command = [options] { return Record(*options); }; });
}

}  // namespace fresco
