// Makes the output of `fresco log info`. Pure functions; any thread may call them.
#pragma once

#include <string>

#include "logs/log_summary.h"
#include "logs/merged_event_logs.h"

namespace fresco {

/// Returns a text for people: channels, runs and actors as tables, and what is missing or damaged.
std::string LogSummaryText(const LogSummary& summary, const MergedEventLogs::Totals& totals);

/// Returns a JSON object with events, bytes, begin_utime, duration_s, damaged_bytes, torn_bytes,
/// foreign_messages, damaged_messages and beyond_limits, and with channels, runs and actors as lists of
/// objects.
std::string LogSummaryJson(const LogSummary& summary, const MergedEventLogs::Totals& totals);

}  // namespace fresco
