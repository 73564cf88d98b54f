// Reads several event logs as one, in the order in which their events were received: the parts of a split
// log, or logs that several hosts recorded of the same run. Only logs that overlap in time are open at once.
// Only one thread may use an object.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bus/bus.h"
#include "logs/event_log_reader.h"

namespace fresco {

class MergedEventLogs {
 public:
  /// What was read, for all logs together.
  struct Totals {
    int64_t bytes = 0;          ///< bytes read
    int64_t damaged_bytes = 0;  ///< damaged bytes that were skipped
    int64_t torn_bytes = 0;     ///< bytes of incomplete last events

    /// Returns a sentence for damage and one for a cut, as far as there is any.
    std::vector<std::string> Problems() const;
  };

  /// Throws UsageError as EventLogReader does.
  explicit MergedEventLogs(const std::vector<std::filesystem::path>& paths);

  /// Returns the next event, valid until the next call; nullopt at the end. Of two events of the same time,
  /// that of the path named first comes first. If time goes backwards within a log, its events keep their
  /// order.
  std::optional<LcmEvent> Next();

  /// The totals so far. They are complete after Next has returned nullopt.
  Totals totals() const;

 private:
  struct Log {
    std::filesystem::path path;
    size_t position = 0;  // among the paths
    int64_t first_utime = 0;
    std::unique_ptr<EventLogReader> reader = nullptr;
    std::optional<LcmEvent> next = {};
  };

  void OpenThoseThatBegin();
  void Advance(Log& log);

  std::deque<Log> waiting_;  // sorted by the time of their first event
  std::vector<Log> open_;    // sorted by position
  Log* handed_out_ = nullptr;
  Totals closed_;
};

}  // namespace fresco
