// Makes the texts that commands show of runs and episodes: a line of progress, a table of results, an episode
// as a table or as JSON. Pure functions; any thread may call them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "msgs/wire.h"
#include "planner/planner.h"
#include "report/report.h"

namespace fresco {

/// Returns a line of progress: episodes, updates, epsilon, the score of greedy episodes (and its gap if the
/// optimum is proved), rates, and who waits for whom. `world` is that of the run. The learner's warning comes
/// first, if there is one, so that a narrow terminal does not cut it off. After the last episode the line
/// begins with what the learner waits for.
std::string ProgressLine(const learner_status_t& status, const WorldDescription& world);

/// Returns a heading and a row for this run, each baseline and the exact optimum, from a summary's JSON. The
/// columns are the policy, the first two figures of the world, the gap and the success; what a world does not
/// have (baselines, an optimum and a gap) is left out. If the optimum is not proved, the last row is the best
/// flight that the search found, and no row has a gap.
/// The first row is of the policy `title`.
std::vector<std::vector<std::string>> PolicyRows(const std::string& summary_json,
                                                 const std::string& title = "this run (DQN)");

/// A judged episode of a summary (JudgementJson in storage/judgement.h).
struct JudgedEpisode {
  std::string group;
  double score = 0;
  double optimal_score = 0;
  double better_baseline = 0;  ///< the better score of the baselines; infinite if there are none
};
/// The judged episodes of a summary whose optimum is proved.
std::vector<JudgedEpisode> ProvedEpisodes(const std::string& summary_json);

/// Returns a heading and a row for each group of judged episodes, then one for all of them: how many they
/// are, the mean, median and worst gap, and the mean gap of the better baseline of each episode. Empty if no
/// episode has a gap.
std::vector<std::vector<std::string>> GapRows(const std::string& summary_json);

/// If there was a search and the optimum is not proved, returns a note: why not, what is proved instead, and
/// what that means for this run. Otherwise returns "".
std::string OptimumNote(const std::string& summary_json);

/// Returns the final table of a run, followed by the note and by the table of gaps, from a summary's JSON.
std::string ResultTable(const std::string& summary_json, const std::string& title = "this run (DQN)");

/// Returns a quantity's title with its unit: "average AoI [slots]".
std::string Label(const Quantity& quantity);

/// Returns a table as text: its heading and a line for each row, columns of numbers at the right.
std::string TableText(const ReportTable& table);

/// Returns a share, 0 to 1, in whole percent: "37 %". It has more digits where "0 %" or "100 %" would be
/// untrue.
std::string PercentText(double share);

/// Returns an object with `policy`, the facts of the account, and its table of steps as a list of objects. If
/// there is a plan, the object also has optimal, lower_bound_total_aoi and lower_bound_average_aoi.
std::string EpisodeJson(const EpisodeAccount& account, const std::string& policy,
                        const std::optional<Plan>& plan = std::nullopt);

/// Returns the account's table of steps as text: a heading and a line for each step.
std::string StepTable(const EpisodeAccount& account);

}  // namespace fresco
