// A retraining with everything that it leaves behind: the folder of a run. Used by one thread; the search for
// the optimum has one of its own.
#pragma once

#include <filesystem>
#include <string>

#include "learner/optimum_search.h"
#include "learner/run_folder.h"
#include "learner/trainer.h"
#include "msgs/experiment.h"
#include "tools/retrain/retrain_report.h"

namespace fresco {

class RetrainRun {
 public:
  /// Reads through the logs. Throws UsageError where they can't be read, Failure where they miss an episode
  /// and `strict` is set.
  RetrainRun(const LogSource& source, const LoggedRun& run, const Experiment& recorded,
             const Experiment& chosen, Retraining::Use use, bool strict);

  /// Trains, and writes the results into a new folder, as `train` does. Returns the summary's JSON with the
  /// report in it. Ends early, with what it has, where the program is asked to stop. Throws UsageError where
  /// the folder holds another run or the experience is too short, Failure where it runs out.
  std::string Train(const std::filesystem::path& directory);

  const RetrainReport& report() const { return report_; }
  bool completed() const { return completed_; }

 private:
  std::string Results(const Trainer& trainer, double wall_s, const OptimumResult& optimum, RunFolder& folder);

  Experiment experiment_;
  World world_;
  bool strict_;
  RetrainReport report_;
  LoggedEpisodes episodes_;
  bool completed_ = false;
};

}  // namespace fresco
