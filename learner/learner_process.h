// Runs a learner from its first order, or from a checkpoint, to its summary. The thread that calls Run
// trains. The object starts three more threads: one for the bus, one that writes files, and one that searches
// for the exact optimum. Construct it and call Run on the same thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "bus/bus.h"
#include "core/memory.h"
#include "learner/learner_node.h"
#include "storage/optimum_search.h"
#include "storage/run_folder.h"
#include "storage/summary.h"
#include "training/trainer.h"

namespace fresco {

struct LearnerOptions {
  std::filesystem::path folder;                  ///< the run's folder; it exists
  int64_t run_id = 0;                            ///< never 0
  RunFolder::Use use = RunFolder::Use::kNewRun;  ///< whether the folder is new or is resumed
  std::optional<Checkpoint> checkpoint = {};     ///< where to continue; none: begin with the first order
};

class LearnerProcess {
 public:
  /// Opens the run's folder and subscribes on `bus`, which must outlive the object. Throws as RunFolder and
  /// Bus::Subscribe do.
  LearnerProcess(const Experiment& experiment, Bus& bus, LearnerOptions options);

  /// Trains and writes the results. Returns true if the training was completed, false if it was interrupted
  /// by a signal or gave up because no result arrived for run.patience_s. Writes a checkpoint if the training
  /// or the search for the optimum was interrupted. Throws UsageError if another learner is on the same
  /// channels, and Failure if the results can't be written.
  bool Run();

 private:
  TrainerOutput Output();
  void RefuseUsedBus();
  void Serve(std::stop_token stop);
  void Train();
  UpdatingFigures UpdatingClocks() const;
  bool GivesUp() const;
  void BeginTraining();
  void WriteCheckpointIfDue();
  void WriteCheckpoint();
  void WaitForOptimum();
  void Report();
  void WriteResults();
  double WallSeconds() const;

  Experiment experiment_;
  LearnerOptions options_;
  Bus* bus_;
  LearnerNode node_;
  Trainer trainer_;
  RunFolder folder_;
  int resumptions_ = 0;
  std::optional<OptimumSearch> optimum_;  // set by Run
  std::exception_ptr network_error_;      // what the network thread threw; Run throws it again
  int64_t begin_us_ = 0;
  double wall_before_s_ = 0;  // wall time of the training before it was resumed
  double wall_s_ = 0;         // wall time of the whole training, once it has ended
  int64_t next_checkpoint_us_ = 0;
  CheckpointFigures checkpoints_;
  std::optional<UpdatingFigures> updating_began_;  // the clocks at this process's first update
  std::optional<UpdatingFigures> updating_;        // set at the end of the training
  std::string finishing_;                          // what it is busy with before it ends
};

/// Returns the most memory that the learner needs: when the replay memory is full and a checkpoint is being
/// written. Small objects are left out. Any thread may call it.
MemoryNeed LearnerMemory(const Experiment& experiment);

}  // namespace fresco
