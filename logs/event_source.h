// The source of events for the subcommands of `fresco log`: one or several event logs, or a live bus. Only
// one thread may use an object.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bus/bus.h"
#include "logs/merged_event_logs.h"

namespace fresco {

class EventSource {
 public:
  virtual ~EventSource() = default;

  /// Returns the next event, valid until the next call; nullopt at the end, and if the program is asked to
  /// stop.
  virtual std::optional<LcmEvent> Next() = 0;

  /// What was read so far. For a bus, only the number of bytes is set.
  virtual MergedEventLogs::Totals totals() const = 0;

  /// Logs warnings for what could not be handed out: damage of a log, losses of a bus.
  virtual void WarnOfLosses() const = 0;
};

/// Opens the sources: paths of event logs, or a single LCM URL. A URL is listened to for `seconds` (0: until
/// the program is asked to stop). Throws UsageError if a source can't be opened.
std::unique_ptr<EventSource> OpenEvents(const std::vector<std::string>& sources, double seconds);

/// Whether this is an LCM URL instead of a path.
bool IsLcmUrl(const std::string& source);

}  // namespace fresco
