// Selects events by time, channel and run, in the same way for every subcommand of `fresco log`. Use a new
// object for each pass through the events. Only one thread may use an object.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bus/bus.h"
#include "logs/channel_filter.h"

namespace fresco {

struct SelectionOptions {
  std::vector<std::string> channels = {};  ///< regular expressions of channels to select; empty: all
  std::vector<std::string> dropped = {};   ///< regular expressions of channels to leave out
  double start_s = 0;                      ///< seconds after the first event, included
  double stop_s = std::numeric_limits<double>::infinity();  ///< seconds after the first event, not included
  std::string run = {};  ///< id of a run in hexadecimal digits, as in summary.json; empty: all
};

class EventSelection {
 public:
  /// Throws UsageError that names the option if its value is wrong.
  explicit EventSelection(const SelectionOptions& options);

  /// Whether the event is selected by its time (start <= time < stop), its channel and its run. Messages that
  /// belong to no run (statuses of actors without a run, foreign messages) are selected whatever `run` is.
  /// Call it for every event, since times count from the first one.
  bool Wants(const LcmEvent& event);

 private:
  bool IsOfAnotherRun(const LcmEvent& event) const;

  ChannelFilter channels_;
  std::optional<ChannelFilter> dropped_;
  double start_us_;
  double stop_us_;
  std::optional<int64_t> run_id_;
  std::optional<int64_t> first_utime_;
};

}  // namespace fresco
