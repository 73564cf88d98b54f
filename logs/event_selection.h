// Which events of a log somebody wants: by time, channel and run. One meaning for every subcommand of
// `fresco log`. An object belongs to one thread and one pass through the events.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bus/lcm_event.h"
#include "logs/channel_filter.h"

namespace fresco {

struct SelectionOptions {
  std::vector<std::string> channels = {};  ///< regular expressions; none: all
  std::vector<std::string> dropped = {};   ///< channels that are left out, as regular expressions
  double start_s = 0;                      ///< from the first event of all
  double stop_s = std::numeric_limits<double>::infinity();
  std::string run = {};  ///< sixteen hexadecimal digits, as summary.json has them; empty: all
};

class EventSelection {
 public:
  /// Throws UsageError naming the option that can't be understood.
  explicit EventSelection(const SelectionOptions& options);

  /// Whether the event is wanted: start <= time < stop, its channel, and its run. What belongs to no run, an
  /// actor without a run and every message that is none of Fresco's, is wanted with any. To be asked of every
  /// event: times count from the first.
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
