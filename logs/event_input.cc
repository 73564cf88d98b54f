#include "logs/event_input.h"

#include <fmt/format.h>

#include "core/clock.h"
#include "core/error.h"
#include "core/live_line.h"
#include "core/signals.h"

namespace fresco {

void AddEventInput(CLI::App& app, EventInputOptions& options) {
  app.add_option("LOG", options.sources, "Event logs, read as one; or one LCM URL to listen to")->required();
  app.add_option("--seconds", options.seconds, "How long to listen to a URL; default: until Ctrl-C")
      ->check(CLI::Range(0.001, 1e9));
  SelectionOptions& selection = options.selection;
  app.add_option("--channel", selection.channels,
                 "Only channels that match this regular expression; may be repeated");
  app.add_option("--drop", selection.dropped,
                 "Leave out channels that match this regular expression; may be repeated");
  app.add_option("--start", selection.start_s, "Only events at least so many seconds after the first one")
      ->check(CLI::Range(0.0, 1e12));
  app.add_option("--stop", selection.stop_s, "Only events less than so many seconds after the first one")
      ->check(CLI::Range(0.0, 1e12));
  app.add_option("--run", selection.run,
                 "Leave out Fresco's messages of other runs than this one (run_id of summary.json)");
}

EventInput::EventInput(const EventInputOptions& options)
    : is_live_(IsLcmUrl(options.sources.front())),
      selection_(options.selection),
      source_(OpenEvents(options.sources, options.seconds)) {}

MergedEventLogs::Totals EventInput::ForEach(const std::function<void(const LcmEvent& event)>& handle) {
  constexpr int64_t kEventsPerLook = 4096;
  constexpr int64_t kQuietUs = 1'000'000;  // no progress is shown before
  const int64_t line_from_us = MonotonicMicroseconds() + kQuietUs;
  LiveLine line(!is_live_);
  int64_t events = 0;
  while (const auto event = source_->Next()) {
    if (selection_.Wants(*event)) {
      handle(*event);
    }
    if (++events % kEventsPerLook == 0 && MonotonicMicroseconds() > line_from_us) {
      line.Show(fmt::format("read {} events, {:.1f} MB", events,
                            1e-6 * static_cast<double>(source_->totals().bytes)));
    }
  }
  line.Finish();
  if (StopSignal::Requested() && !is_live_) {
    throw Failure("interrupted before the end of the logs");
  }
  source_->WarnOfLosses();
  return source_->totals();
}

}  // namespace fresco
