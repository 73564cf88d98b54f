// A run's folder: config.textproto, metrics.csv, best.network, final.network, optimum.json, summary.json
// and checkpoints/. Every file is whole at any time. What changes during the training is written by a
// thread of its own; a full disk does not stop the training. Used by one thread; one process at a time
// works in a folder, which is for the callers to see to (core/folder_lock.h).
#pragma once

#include <filesystem>
#include <string>

#include "msgs/experiment.h"
#include "storage/checkpoint_folder.h"
#include "storage/file_writer.h"
#include "training/training_state.h"

namespace fresco {

class RunFolder {
 public:
  enum class Use { kNewRun, kResume };

  /// Checks, without making or changing anything, that a new run can have this folder: it can be made or
  /// written to, no process works in it, and it holds no other run. Throws UsageError otherwise.
  static void CheckNew(const std::filesystem::path& directory);

  /// Makes a folder, and those above it. Throws UsageError where it can't.
  static void Make(const std::filesystem::path& directory);

  /// Makes the folder and writes the configuration. Throws UsageError where the folder can't be made or
  /// (kNewRun) holds another run. kResume: takes over what an incomplete run has left, and clears its
  /// half-written files away.
  RunFolder(std::filesystem::path directory, const Experiment& experiment, Use use = Use::kNewRun);

  const std::filesystem::path& directory() const { return directory_; }

  // ---- During the training; these return at once.
  /// Adds an evaluation and what it stands beside to metrics.csv.
  void AddMetrics(const Evaluation& evaluation, const TrainerProgress& progress, double wall_s);
  void WriteBest(const BestNetwork& best);
  void WriteCheckpoint(std::shared_ptr<const Checkpoint> checkpoint);
  /// Whether the checkpoint before is still being written.
  bool CheckpointIsBusy() const { return writer_.IsBusy(kCheckpoint); }
  /// What can't be written now; empty: nothing.
  std::string problem() const { return writer_.problem(); }

  /// The text of metrics.csv so far, and to go on from.
  const std::string& metrics() const { return metrics_; }
  void RestoreMetrics(std::string metrics) { metrics_ = std::move(metrics); }

  // ---- At the end; these throw Failure where the disk does not take it.
  /// Waits until everything of the above is written.
  void Finish() { writer_.Finish(); }
  void WriteFinal(const Vector& parameters, const TrainerProgress& progress);
  void WriteSummary(const std::string& json);
  void WriteOptimum(const std::string& json);

 private:
  static constexpr char kCheckpoint[] = "checkpoint";

  static void RefuseResults(const std::filesystem::path& directory);
  void ClearLeftovers() const;

  std::filesystem::path directory_;
  Experiment experiment_;
  CheckpointFolder checkpoints_;
  std::string metrics_;
  FileWriter writer_;
};

/// For an error's text, if `folder` is not the folder of a run but holds such folders: "; the newest run in
/// it is runs/NAME", that with the newest `file`. "" if no folder in it has that file.
std::string NewestRunHint(const std::filesystem::path& folder, const std::string& file);

}  // namespace fresco
