// Makes the texts that `train` shows of a run: a line of progress, and a table at the end. Pure functions;
// any thread may call them.
#pragma once

#include <string>
#include <vector>

#include "msgs/wire.h"

namespace fresco {

/// Returns a line of progress: episodes, updates, epsilon, greedy average AoI (and its gap if the optimum is
/// proved), rates, and who waits for whom. The learner's warning comes first, if there is one, so that a
/// narrow terminal does not cut it off. After the last episode the line begins with what the learner waits
/// for.
std::string ProgressLine(const learner_status_t& status);

/// Returns a heading and a row for this run, each baseline and the exact optimum, from a summary's JSON. The
/// columns are policy, average AoI, total AoI, gap, arrived. If the optimum is not proved, the last row is
/// the best flight that the search found, and no row has a gap.
std::vector<std::vector<std::string>> PolicyRows(const std::string& summary_json);

/// If there was a search and the optimum is not proved, returns a note: why not, what is proved instead, and
/// what that means for this run. Otherwise returns "".
std::string OptimumNote(const std::string& summary_json);

/// Returns the final table of a run, followed by the note, from a summary's JSON.
std::string ResultTable(const std::string& summary_json);

}  // namespace fresco
