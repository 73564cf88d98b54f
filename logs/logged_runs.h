// The runs that LCM event logs hold, found by what their learners announce and their messages carry.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "logs/log_messages.h"
#include "msgs/wire.h"

namespace fresco {

struct LoggedRun {
  RunIdentity identity;
  int64_t transitions_messages = 0;
  std::optional<int32_t> protocol_version = {};        ///< of its messages; none: it was not recorded
  std::optional<int64_t> arithmetic_fingerprint = {};  ///< of the learner; none: it was not recorded
  std::optional<std::string> config_text = {};         ///< none: not every part of it was recorded
};

/// The run's id as people write it: 16 hexadecimal digits.
std::string RunIdText(const LoggedRun& run);

/// Those of which transitions or the configuration were recorded, in the order in which they appear. Throws
/// UsageError where a log can't be read.
std::vector<LoggedRun> FindLoggedRuns(const LogSource& source);

/// The one with this id, as RunIdText writes it; with an empty text the only one. Throws
/// UsageError that lists the runs where that does not name one.
LoggedRun ChooseLoggedRun(const std::vector<LoggedRun>& runs, const std::string& run_id);

/// Throws UsageError if the run's orders are those of another release, which mean other episodes.
void ExpectOrdersOfThisRelease(const LoggedRun& run);

}  // namespace fresco
