// Runs a retraining, reports about it, and writes its results to the folder of a run.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "logs/logged_episodes.h"
#include "logs/retraining.h"
#include "msgs/experiment.h"
#include "storage/optimum_search.h"
#include "storage/run_folder.h"
#include "training/trainer.h"

namespace fresco {

/// What a retraining says about the logs and the trained agent.
struct RetrainReport {
  LogPaths logs;
  LoggedRun run;
  Retraining::Use use = Retraining::Use::kSameRun;
  std::vector<Interval> missing = {};  ///< see LoggedEpisodes::Missing
  MergedEventLogs::Totals totals = {};
  int64_t refused = 0;  ///< messages that are not authenticated with the key
  Retraining::Counts counts = {};
};

// The following functions are pure; any thread may call them.

/// Returns ranges as text: "3, 17 to 20 and 2 more ranges (9 orders in all)".
std::string RangesText(const std::vector<Interval>& ranges);

/// Returns the text to print before the training: which run the logs contain, and what its episodes are used
/// for.
std::string BeginText(const RetrainReport& report);

/// Returns the text to print after the training: which episodes came from the logs, which were flown, and
/// whether the result is the recorded run.
std::string EndText(const RetrainReport& report);

/// Returns a summary's JSON with the report added as "retrain".
std::string WithRetrainReport(const std::string& summary_json, const RetrainReport& report);

/// Only one thread may use an object; the search for the optimum has a thread of its own.
class RetrainRun {
 public:
  /// Reads the logs and writes nothing. Throws UsageError if they can't be read or contain too little
  /// experience, and Failure if `strict` is set and an episode is missing.
  RetrainRun(const LogSource& source, const LoggedRun& run, const Experiment& recorded,
             const Experiment& chosen, Retraining::Use use, bool strict);
  RetrainRun(const RetrainRun&) = delete;
  RetrainRun& operator=(const RetrainRun&) = delete;

  /// Trains and writes the results to a new folder, as `train` does. Call it once. Returns the summary's JSON
  /// with the report in it. If the program is asked to stop, ends early and writes the results so far. Throws
  /// UsageError if the folder holds another run, and Failure if the experience runs out.
  std::string Train(const std::filesystem::path& directory);

  const RetrainReport& report() const { return report_; }
  bool completed() const { return completed_; }

 private:
  void WriteEvaluation(const Trainer& trainer, const Evaluation& evaluation);
  std::string Results(double wall_s, const OptimumResult& optimum);

  Experiment experiment_;
  Experiment recorded_;
  RetrainReport report_;
  LoggedEpisodes episodes_;
  std::optional<Retraining> retraining_;
  std::optional<RunFolder> folder_;  // set by Train
  int64_t begin_us_ = 0;             // when Train began
  bool completed_ = false;
};

}  // namespace fresco
