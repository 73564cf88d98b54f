#include "logs/event_input.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <limits>

#include "bus/bus.h"
#include "core/clock.h"
#include "core/error.h"
#include "core/live_line.h"
#include "core/signals.h"
#include "logs/bus_losses.h"

namespace fresco {
namespace {

bool IsLcmUrl(const std::string& source) {
  return source.find("://") != std::string::npos;
}

}  // namespace

class EventInput::LiveBus {
 public:
  LiveBus(const std::string& url, double seconds) : bus_(OpenLcmBus(url)) {
    if (seconds > 0) {
      end_us_ = MonotonicMicroseconds() + static_cast<int64_t>(1e6 * seconds);
    }
    bus_->SubscribeToAll([this](const LcmEvent& event) { Copy(event); });
  }

  std::optional<LcmEvent> Next() {
    constexpr int64_t kPollUs = 100'000;
    taken_ = false;
    while (!taken_ && !StopSignal::Requested()) {
      const int64_t left_us = end_us_ - MonotonicMicroseconds();
      if (left_us <= 0) {
        return std::nullopt;
      }
      bus_->Poll(std::min(kPollUs, left_us), 1);
    }
    return taken_ ? std::optional(event_) : std::nullopt;
  }

  int64_t bytes() const { return bytes_; }
  const Bus& bus() const { return *bus_; }

 private:
  /// Copies the event, since it is valid during the call only.
  void Copy(const LcmEvent& event) {
    channel_.assign(event.channel);
    message_.assign(event.message.begin(), event.message.end());
    event_ = {event.number, event.utime, channel_, message_};
    bytes_ += static_cast<int64_t>(channel_.size() + message_.size());
    taken_ = true;
  }

  std::unique_ptr<Bus> bus_;
  int64_t end_us_ = std::numeric_limits<int64_t>::max();
  std::string channel_;
  std::vector<std::byte> message_;
  LcmEvent event_;
  int64_t bytes_ = 0;
  bool taken_ = false;
};

void AddEventInput(CLI::App& app, EventInputOptions& options) {
  app.add_option("LOG", options.sources, "Event logs, read as one; or one LCM URL to listen to")->required();
  app.add_option("--seconds", options.seconds, "How long to listen to a URL; default: until Ctrl-C")
      ->check(CLI::Range(0.001, 1e9));
  SelectionOptions& selection = options.selection;
  app.add_option("--channel", selection.channels,
                 "Only channels that match this regular expression; may be repeated")
      ->type_name("REGEX");
  app.add_option("--drop", selection.dropped,
                 "Leave out channels that match this regular expression; may be repeated")
      ->type_name("REGEX");
  app.add_option("--start", selection.start_s, "Only events at least so many seconds after the first one")
      ->check(CLI::Range(0.0, 1e12));
  app.add_option("--stop", selection.stop_s, "Only events less than so many seconds after the first one")
      ->check(CLI::Range(0.0, 1e12));
  app.add_option("--run", selection.run,
                 "Leave out Fresco's messages of other runs than this one (run_id of summary.json)")
      ->type_name("RUN_ID");
}

EventInput::EventInput(const EventInputOptions& options) : selection_(options.selection) {
  const std::vector<std::string>& sources = options.sources;
  if (std::none_of(sources.begin(), sources.end(), IsLcmUrl)) {
    logs_.emplace(std::vector<std::filesystem::path>(sources.begin(), sources.end()));
  } else if (sources.size() == 1) {
    bus_ = std::make_unique<LiveBus>(sources.front(), options.seconds);
  } else {
    throw UsageError("expected event logs, or one LCM URL alone; found " + sources[0] + " beside " +
                     sources[1]);
  }
}

EventInput::~EventInput() = default;

std::optional<LcmEvent> EventInput::NextOfAll() {
  if (is_live()) {
    return bus_->Next();
  }
  return StopSignal::Requested() ? std::nullopt : logs_->Next();
}

std::optional<LcmEvent> EventInput::Next() {
  while (const auto event = NextOfAll()) {
    if (selection_.Wants(*event)) {
      return event;
    }
  }
  return std::nullopt;
}

MergedEventLogs::Totals EventInput::totals() const {
  return is_live() ? MergedEventLogs::Totals{bus_->bytes(), 0, 0} : logs_->totals();
}

void EventInput::WarnOfLosses() const {
  if (is_live()) {
    WarnOfBusLosses(bus_->bus());
  } else {
    for (const std::string& problem : logs_->totals().Problems()) {
      spdlog::warn("{}", problem);
    }
  }
}

MergedEventLogs::Totals EventInput::ForEach(const std::function<void(const LcmEvent& event)>& handle) {
  constexpr int64_t kEventsPerLook = 4096;
  constexpr int64_t kQuietUs = 1'000'000;  // no progress is shown before
  const int64_t line_from_us = MonotonicMicroseconds() + kQuietUs;
  LiveLine line(!is_live());
  int64_t events = 0;
  while (const auto event = NextOfAll()) {
    if (selection_.Wants(*event)) {
      handle(*event);
    }
    if (++events % kEventsPerLook == 0 && MonotonicMicroseconds() > line_from_us) {
      line.Show(fmt::format("read {} events, {:.1f} MB", events, 1e-6 * static_cast<double>(totals().bytes)));
    }
  }
  line.Finish();
  if (StopSignal::Requested() && !is_live()) {
    throw Failure("interrupted before the end of the logs");
  }
  WarnOfLosses();
  return totals();
}

}  // namespace fresco
