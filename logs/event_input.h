// What every subcommand of `fresco log` that reads does: its options, and the pass through the events.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bus/lcm_event.h"
#include "logs/event_selection.h"
#include "logs/event_source.h"
#include "logs/merged_event_logs.h"

namespace fresco {

struct EventInputOptions {
  std::vector<std::string> sources;  ///< as OpenEvents has them
  double seconds = 0;                ///< of listening, where the source is a URL
  SelectionOptions selection;
};

/// Adds LOG..., --seconds, --channel, --drop, --start, --stop and --run; `options` must outlive the parsing.
void AddEventInput(CLI::App& app, EventInputOptions& options);

/// One pass through the events. Belongs to one thread.
class EventInput {
 public:
  /// Checks the options and opens the sources, so that a subcommand makes its output only after that. Throws
  /// UsageError.
  explicit EventInput(const EventInputOptions& options);

  /// Calls `handle` for every event that is wanted, in order, and shows on standard error how far it is; says
  /// there at the end what was damaged, cut or lost. Throws Failure if the program is interrupted while it
  /// reads logs.
  MergedEventLogs::Totals ForEach(const std::function<void(const LcmEvent& event)>& handle);

 private:
  bool is_live_;
  EventSelection selection_;
  std::unique_ptr<EventSource> source_;
};

}  // namespace fresco
