// Parses values of the command line: path=value settings and run ids. Pure functions; any thread may call
// them.
#pragma once

#include <string>
#include <vector>

#include "msgs/experiment.h"

namespace fresco {

/// Splits each path=value: {"schedule.seed=3"} becomes {{"schedule.seed", "3"}}. Throws UsageError if the
/// path or the '=' is missing.
Settings ParseSettings(const std::vector<std::string>& arguments);

/// Parses 1 to 16 hexadecimal digits as a 64-bit id. Throws UsageError for any other text, and for 0.
int64_t ParseRunId(const std::string& text);

}  // namespace fresco
