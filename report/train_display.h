// What a person sees of a run: a line while it is going, a table at the end. Pure.
#pragma once

#include <string>
#include <vector>

#include "msgs/wire.h"

namespace fresco {

/// One line: first the learner's warning, if there is one, which no narrow terminal may cut off; episodes,
/// updates, epsilon, greedy average AoI and, once the optimum is proved, its gap, rates, who waits for whom.
/// After the last episode it begins with what is waited for.
std::string ProgressLine(const learner_status_t& status);

/// A heading and a row for this run, each baseline and the exact optimum, from a summary's JSON: policy,
/// average AoI, total AoI, gap, arrived. If the optimum is not proved, the best flight that the search found
/// stands in its place, and no row has a gap.
std::vector<std::vector<std::string>> PolicyRows(const std::string& summary_json);

/// If the optimum was searched for and is not proved: why, what is proved instead, and what follows from that
/// for this run. Empty otherwise.
std::string OptimumNote(const std::string& summary_json);

/// The final table: the rows, then the note, from a summary's JSON.
std::string ResultTable(const std::string& summary_json);

}  // namespace fresco
