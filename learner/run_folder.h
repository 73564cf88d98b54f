// A run's folder: config.textproto, metrics.csv, best.network, final.network, optimum.json,
// summary.json. Every
// file is whole at any time. Used by one thread.
#pragma once

#include <filesystem>
#include <string>

#include "learner/trainer.h"
#include "msgs/experiment.h"

namespace fresco {

class RunFolder {
 public:
  /// Makes the folder and writes the configuration. Throws UsageError where the folder holds another
  /// run's summary or can't be made.
  RunFolder(std::filesystem::path directory, const Experiment& experiment);

  const std::filesystem::path& directory() const { return directory_; }

  /// Adds an evaluation and what it stands beside to metrics.csv.
  void AddMetrics(const Evaluation& evaluation, const TrainerProgress& progress, double wall_s);
  void WriteBest(const BestNetwork& best);
  void WriteFinal(const Vector& parameters, const TrainerProgress& progress);
  void WriteSummary(const std::string& json);
  void WriteOptimum(const std::string& json);

 private:
  std::filesystem::path directory_;
  Experiment experiment_;
  std::string metrics_;
};

}  // namespace fresco
