// path=value settings of command lines. Pure.
#pragma once

#include <string>
#include <vector>

#include "msgs/experiment.h"

namespace fresco {

/// {"schedule.seed=3"} -> {{"schedule.seed", "3"}}. Throws UsageError where there is no path or no '='.
Settings ParseSettings(const std::vector<std::string>& arguments);

/// The 64-bit id that 1 to 16 hexadecimal digits stand for. Throws UsageError otherwise, and for 0.
int64_t ParseRunId(const std::string& text);

}  // namespace fresco
