// Where the subcommands of `fresco log` have their events from: event logs, several as one, or a bus that is
// listened to. An object belongs to one thread.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bus/lcm_event.h"
#include "logs/merged_event_logs.h"

namespace fresco {

class EventSource {
 public:
  virtual ~EventSource() = default;

  /// The next event, valid until the next call; nullopt at the end, and where the program is asked to stop.
  virtual std::optional<LcmEvent> Next() = 0;

  /// What was read so far; of a bus, the bytes only.
  virtual MergedEventLogs::Totals totals() const = 0;

  /// Says on standard error what could not be handed out: damage of a log, losses of a bus.
  virtual void WarnOfLosses() const = 0;
};

/// `sources`: paths of event logs, or one LCM URL alone, which is listened to for `seconds` (0: until the
/// program is asked to stop). Throws UsageError where one can't be opened.
std::unique_ptr<EventSource> OpenEvents(const std::vector<std::string>& sources, double seconds);

/// Whether this is an LCM URL and no path.
bool IsLcmUrl(const std::string& source);

}  // namespace fresco
