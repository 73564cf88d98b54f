// Writes the files of a run's folder: config.textproto, start.network, metrics.csv and its other forms
// (metrics.h), best.network, final.network, optimum.json, summary.json and checkpoints/. Every file is
// complete at all times. A thread of its own (FileWriter) writes the files that change during the training,
// so a full disk does not stop the training. LearnerProcess owns one; only its training thread may use it.
// Only one process at a time may work in a folder; callers make sure of that (core/files.h).
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "msgs/experiment.h"
#include "planner/planner.h"
#include "storage/checkpoint_folder.h"
#include "storage/file_writer.h"
#include "training/training_state.h"

namespace fresco {

class RunFolder {
 public:
  /// Whether the folder is for a new run or holds a run to resume.
  enum class Use { kNewRun, kResume };

  /// Checks that a new run can use this folder: it can be made or written to, no process works in it, and it
  /// holds no other run. Throws UsageError otherwise. Makes and changes nothing.
  static void CheckNew(const std::filesystem::path& directory);

  /// Makes a folder and those above it. Throws UsageError if it can't.
  static void Make(const std::filesystem::path& directory);

  /// Makes the folder and writes the configuration. kNewRun: throws UsageError if the folder holds another
  /// run. kResume: keeps the files of the incomplete run and deletes its half-written ones. Throws UsageError
  /// if the folder can't be made.
  RunFolder(std::filesystem::path directory, const Experiment& experiment, Use use = Use::kNewRun);

  /// Gives the experiment of a folder the network with which its training starts, if it starts from one
  /// (start.network). Throws UsageError as Experiment::FirstParameters does, or if the file can't be used.
  static Experiment WithStart(const Experiment& experiment, const std::filesystem::path& directory);

  const std::filesystem::path& directory() const { return directory_; }

  // ---- For use during the training. These functions return at once.
  /// Adds a line to metrics.csv and its other forms.
  void AddMetrics(const Evaluation& evaluation, const TrainerProgress& progress, double wall_s);
  void WriteBest(const BestNetwork& best);
  void WriteCheckpoint(std::shared_ptr<const Checkpoint> checkpoint);
  /// Writes optimum.json, unless there is no plan (plans.h).
  void WriteOptimum(std::vector<uint64_t> seeds, std::vector<std::shared_ptr<const Plan>> plans);
  /// Whether the last checkpoint waits or is being written.
  bool CheckpointIsBusy() const { return writer_.IsBusy(kCheckpoint); }
  /// Which file can't be written at present, and why; empty if there is none.
  std::string problem() const { return writer_.problem(); }

  /// The proved plans of these episodes that optimum.json already has, by episode; null where it has none.
  /// Reads the file, and logs a warning if it can't be used.
  std::vector<std::shared_ptr<const Plan>> ReadOptimum(std::span<const uint64_t> seeds) const;

  /// The text of metrics.csv so far. RestoreMetrics sets it when a run is resumed.
  const std::string& metrics() const { return metrics_; }
  void RestoreMetrics(std::string metrics) { metrics_ = std::move(metrics); }

  // ---- For use at the end. These functions throw Failure if a file can't be written.
  /// Waits until all files from above are written.
  void Finish() { writer_.Finish(); }
  void WriteFinal(const Vector& parameters, const TrainerProgress& progress);
  void WriteSummary(const std::string& json);

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

/// A hint for the error that `folder` is not the folder of a run. If it contains folders of runs, returns ";
/// the newest run in it is runs/NAME", which is the one with the newest `file`. Returns "" if no folder in it
/// has that file.
std::string NewestRunHint(const std::filesystem::path& folder, const std::string& file);

/// Returns runs/<time>-<process id> below the current directory; the time is the present one, UTC. Does not
/// make the folder. Any thread may call it.
std::filesystem::path NewRunFolder();

}  // namespace fresco
