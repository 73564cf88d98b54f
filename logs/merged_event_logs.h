// Several event logs as one, in the order in which their events were received: the parts of a split log, or
// what recorders on several hosts wrote of the same run. Only logs that overlap in time are open at once.
// Belongs to one thread.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "bus/lcm_event.h"
#include "logs/event_log_reader.h"

namespace fresco {

class MergedEventLogs {
 public:
  /// What was read, of all logs together.
  struct Totals {
    int64_t bytes = 0;
    int64_t damaged_bytes = 0;  ///< skipped; no events
    int64_t torn_bytes = 0;     ///< of a last event that was cut
  };

  /// Throws UsageError as EventLogReader does.
  explicit MergedEventLogs(const std::vector<std::filesystem::path>& paths);

  /// The next event, valid until the next call; of two of the same time, that of the path named first.
  /// nullopt at the end. An event whose clock went backwards in its log keeps its place there.
  std::optional<LcmEvent> Next();

  /// So far; whole once Next has returned nullopt.
  Totals totals() const;

 private:
  struct Log {
    std::filesystem::path path;
    size_t place = 0;  // among the paths
    int64_t first_utime = 0;
    std::unique_ptr<EventLogReader> reader = nullptr;
    std::optional<LcmEvent> next = {};
  };

  void OpenThoseThatBegin();
  void Advance(Log& log);

  std::deque<Log> waiting_;  // by the time of their first event
  std::vector<Log> open_;    // by place
  Log* handed_out_ = nullptr;
  Totals closed_;
};

}  // namespace fresco
