// The options of the subcommands of `fresco log` that read events, and the loop over the events.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bus/bus.h"
#include "logs/event_selection.h"
#include "logs/event_source.h"
#include "logs/merged_event_logs.h"

namespace fresco {

struct EventInputOptions {
  std::vector<std::string> sources;  ///< paths of logs, or one LCM URL; see OpenEvents
  double seconds = 0;                ///< how long to listen to a URL; 0: until the program is asked to stop
  SelectionOptions selection;
};

/// Adds LOG..., --seconds, --channel, --drop, --start, --stop and --run, whose values parsing writes to
/// `options`.
void AddEventInput(CLI::App& app, EventInputOptions& options);

/// One pass through the events. Only one thread may use an object.
class EventInput {
 public:
  /// Checks the options and opens the sources. A subcommand makes its output after that, so wrong use leaves
  /// nothing behind. Throws UsageError.
  explicit EventInput(const EventInputOptions& options);

  /// Calls `handle` for every selected event, in order. Shows progress on standard error, and at the end
  /// warns there of damaged, cut or lost events. Throws Failure if the program is interrupted while it reads
  /// logs.
  MergedEventLogs::Totals ForEach(const std::function<void(const LcmEvent& event)>& handle);

 private:
  bool is_live_;
  EventSelection selection_;
  std::unique_ptr<EventSource> source_;
};

}  // namespace fresco
