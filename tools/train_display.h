// What a person sees of a run: a line while it is going, a table at the end. Pure.
#pragma once

#include <string>
#include <vector>

#include "msgs/wire.h"

namespace fresco {

/// One line: first the learner's warning, if there is one, which no narrow terminal may cut off; episodes,
/// updates, epsilon, greedy average AoI and its gap to the optimum, rates, who waits for whom.
std::string ProgressLine(const learner_status_t& status);

/// A heading and a row for this run, each baseline and the exact optimum (or the lower bound on it), from
/// a summary's JSON: policy, average AoI, total AoI, gap, arrived.
std::vector<std::vector<std::string>> PolicyRows(const std::string& summary_json);

/// The final table: this run, the baselines and the exact optimum, with their gaps, from a summary's JSON.
std::string ResultTable(const std::string& summary_json);

}  // namespace fresco
