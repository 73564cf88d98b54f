// Finds the runs that LCM event logs contain, by the learners' announcements and the identity in each
// message. The functions may be called from any thread.
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
  std::optional<int32_t> protocol_version = {};        ///< of its messages; none if it was not recorded
  std::optional<int64_t> arithmetic_fingerprint = {};  ///< of the learner; none if it was not recorded
  std::optional<std::string> config_text = {};         ///< none if some part of it was not recorded
};

/// Returns the run's id as 16 hexadecimal digits.
std::string RunIdText(const LoggedRun& run);

/// Returns the runs of which transitions or the configuration were recorded, in the order in which they
/// appear. Throws UsageError if a log can't be read.
std::vector<LoggedRun> FindLoggedRuns(const LogSource& source);

/// Returns the run with this id (in the form of RunIdText), or the only run if the text is empty. Throws
/// UsageError that lists the runs if there is no such run or if the text is empty and there are several.
LoggedRun ChooseLoggedRun(const std::vector<LoggedRun>& runs, const std::string& run_id);

/// Throws UsageError if another release recorded the run and its orders mean other episodes in this one.
void ExpectOrdersOfThisRelease(const LoggedRun& run);

}  // namespace fresco
