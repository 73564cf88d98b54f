// The report of a retraining about the logs and the trained agent, as text for people and as JSON. Pure
// functions; any thread may call them.
#pragma once

#include <string>

#include "logs/logged_episodes.h"
#include "logs/retraining.h"

namespace fresco {

struct RetrainReport {
  LogPaths logs;
  LoggedRun run;
  Retraining::Use use = Retraining::Use::kSameRun;
  std::vector<std::pair<int64_t, int64_t>> missing = {};  ///< see LoggedEpisodes::Missing
  MergedEventLogs::Totals totals = {};
  int64_t refused = 0;  ///< messages that are not authenticated with the key
  Retraining::Counts counts = {};
};

/// Returns ranges as text: "3, 17 to 20 and 2 more ranges (9 orders in all)".
std::string RangesText(const std::vector<std::pair<int64_t, int64_t>>& ranges);

/// Returns the text to print before the training: which run the logs contain, and what its episodes are used
/// for.
std::string BeginText(const RetrainReport& report);

/// Returns the text to print after the training: which episodes came from the logs, which were flown, and
/// whether the result is the recorded run.
std::string EndText(const RetrainReport& report);

/// Returns a summary's JSON with the report added as "retrain".
std::string WithRetrainReport(const std::string& summary_json, const RetrainReport& report);

}  // namespace fresco
