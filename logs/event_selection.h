// Selects events of a bus or a log by time, channel and run. Only one thread may use an object.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

#include "bus/bus.h"

namespace fresco {

/// Selects channels by regular expressions, which must match a channel's whole name, as in LCM.
class ChannelFilter {
 public:
  /// Selects every channel.
  ChannelFilter() = default;
  /// Selects the channels that match one of the expressions; every channel if there are no expressions.
  /// Throws UsageError if one is not a regular expression; the error names `option`, the command line option
  /// it came from.
  ChannelFilter(const std::vector<std::string>& expressions, const std::string& option);

  bool Matches(std::string_view channel);
  bool lets_all_through() const { return expressions_.empty(); }

 private:
  std::vector<std::regex> expressions_;
  std::map<std::string, bool, std::less<>> known_;  // results for names that came before
};

struct SelectionOptions {
  std::vector<std::string> channels = {};  ///< regular expressions of channels to select; empty: all
  std::vector<std::string> dropped = {};   ///< regular expressions of channels to leave out
  double start_s = 0;  ///< seconds after the first event, included; 0: all, also if the clock went backwards
  double stop_s = std::numeric_limits<double>::infinity();  ///< seconds after the first event, not included
  std::string run = {};  ///< id of a run in hexadecimal digits, as in summary.json; empty: all
};

/// Selects events in the same way for every subcommand of `fresco log`. Use a new object for each pass
/// through the events.
class EventSelection {
 public:
  /// Throws UsageError that names the option if its value is wrong.
  explicit EventSelection(const SelectionOptions& options);

  /// Whether the event is selected by its time (start <= time < stop), its channel and its run. Messages that
  /// belong to no run (statuses of actors without a run, foreign messages) are selected whatever `run` is.
  /// Call it for every event, since times count from the first one.
  bool Wants(const LcmEvent& event);

  /// The time of an event, seconds after the first one. Call it after Wants.
  double SecondsOf(const LcmEvent& event) const;

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
