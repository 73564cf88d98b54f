// Parses settings of the command line. A pure function; any thread may call it.
#pragma once

#include <string>
#include <vector>

#include "msgs/experiment.h"

namespace fresco {

/// Splits each path=value: {"schedule.seed=3"} becomes {{"schedule.seed", "3"}}. Throws UsageError if the
/// path or the '=' is missing.
Settings ParseSettings(const std::vector<std::string>& arguments);

}  // namespace fresco
