// What the subcommands of `fresco log` read: events of logs or of a live bus, and the options that choose
// them.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bus/bus.h"
#include "logs/event_selection.h"
#include "logs/merged_event_logs.h"

namespace fresco {

struct EventInputOptions {
  std::vector<std::string> sources;  ///< paths of logs, which are read as one; or a single LCM URL
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
  ~EventInput();

  /// Whether the events come from a bus.
  bool is_live() const { return bus_ != nullptr; }

  /// Returns the next selected event, valid until the next call; nullopt at the end, and if the program is
  /// asked to stop.
  std::optional<LcmEvent> Next();
  /// The time of an event, seconds after the first one, selected or not.
  double SecondsOf(const LcmEvent& event) const { return selection_.SecondsOf(event); }
  /// Logs warnings for what could not be handed out: damage of a log, losses of a bus.
  void WarnOfLosses() const;

  /// Calls `handle` for every selected event, in order. Shows progress on standard error, and at the end
  /// warns of losses. Returns what was read; for a bus, only the number of bytes. Throws Failure if the
  /// program is interrupted while it reads logs.
  MergedEventLogs::Totals ForEach(const std::function<void(const LcmEvent& event)>& handle);

 private:
  class LiveBus;

  std::optional<LcmEvent> NextOfAll();
  MergedEventLogs::Totals totals() const;

  EventSelection selection_;
  std::optional<MergedEventLogs> logs_;
  std::unique_ptr<LiveBus> bus_;  // set instead of logs_ if the source is a URL
};

}  // namespace fresco
