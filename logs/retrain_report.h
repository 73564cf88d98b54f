// What a retraining has to say of the logs and of the agent it trained, for people and as JSON. Pure.
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
  int64_t refused = 0;  ///< messages without a tag of the key
  Retraining::Counts counts = {};
};

/// "3, 17 to 20 and 2 more ranges (9 orders in all)".
std::string RangesText(const std::vector<std::pair<int64_t, int64_t>>& ranges);

/// Before the training: which run the logs hold, and what its episodes are used for.
std::string BeginText(const RetrainReport& report);

/// After it: what was taken from the logs, what was flown, and whether it is the run that was recorded.
std::string EndText(const RetrainReport& report);

/// A summary's JSON with the report in it, as "retrain".
std::string WithRetrainReport(const std::string& summary_json, const RetrainReport& report);

}  // namespace fresco
