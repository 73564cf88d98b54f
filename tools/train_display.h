// What a person sees of a run: a line while it is going, a table at the end. Pure.
#pragma once

#include <string>

#include "msgs/wire.h"

namespace fresco {

/// One line: episodes, updates, epsilon, greedy average AoI and its gap to the optimum, rates, who waits for
/// whom.
std::string ProgressLine(const learner_status_t& status);

/// The final table: this run, the baselines and the exact optimum, with their gaps, from a summary's JSON.
std::string ResultTable(const std::string& summary_json);

}  // namespace fresco
