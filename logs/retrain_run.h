// Runs a retraining and writes its results to the folder of a run. Only one thread may use an object; the
// search for the optimum has a thread of its own.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "logs/retrain_report.h"
#include "msgs/experiment.h"
#include "storage/optimum_search.h"
#include "storage/run_folder.h"
#include "training/trainer.h"

namespace fresco {

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
  void TakeEvaluation(const Trainer& trainer, const Evaluation& evaluation);
  std::string Results(double wall_s, const OptimumResult& optimum);

  Experiment experiment_;
  World world_;
  RetrainReport report_;
  LoggedEpisodes episodes_;
  std::optional<Retraining> retraining_;
  std::optional<RunFolder> folder_;  // set by Train
  int64_t begin_us_ = 0;             // when Train began
  bool completed_ = false;
};

}  // namespace fresco
