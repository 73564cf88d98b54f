// A retraining with everything that it leaves behind: the folder of a run. Used by one thread; the search for
// the optimum has one of its own.
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
  /// Reads through the logs; nothing is written before Train. Throws UsageError if they can't be read or hold
  /// too little experience, Failure if they miss an episode and `strict` is set.
  RetrainRun(const LogSource& source, const LoggedRun& run, const Experiment& recorded,
             const Experiment& chosen, Retraining::Use use, bool strict);
  RetrainRun(const RetrainRun&) = delete;
  RetrainRun& operator=(const RetrainRun&) = delete;

  /// Trains, and writes the results into a new folder, as `train` does; to be called once. Returns the
  /// summary's JSON with the report in it. Ends early, with what it has, if the program is asked to stop.
  /// Throws UsageError if the folder holds another run, Failure if the experience runs out.
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
  std::optional<RunFolder> folder_;  // from Train on
  int64_t begin_us_ = 0;             // of Train
  bool completed_ = false;
};

}  // namespace fresco
