// What `fresco log info` prints. Pure.
#pragma once

#include <string>

#include "logs/log_summary.h"
#include "logs/merged_event_logs.h"

namespace fresco {

/// For people: channels, runs and actors as tables, and what is missing or damaged.
std::string LogSummaryText(const LogSummary& summary, const MergedEventLogs::Totals& totals);

/// One object: events, bytes, begin_utime, duration_s, damaged_bytes, torn_bytes, foreign_messages,
/// damaged_messages, beyond_limits; channels, runs and actors as lists of objects.
std::string LogSummaryJson(const LogSummary& summary, const MergedEventLogs::Totals& totals);

}  // namespace fresco
