// One run of a learner from its first order, or from a checkpoint, to its summary: the training thread
// that calls Run, a network thread beside it, a thread that writes files, and the search for the optimum.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "bus/bus.h"
#include "learner/learner_node.h"
#include "storage/optimum_search.h"
#include "storage/run_folder.h"
#include "storage/summary.h"
#include "training/trainer.h"

namespace fresco {

struct LearnerOptions {
  std::filesystem::path folder;
  int64_t run_id = 0;
  RunFolder::Use use = RunFolder::Use::kNewRun;
  std::optional<Checkpoint> checkpoint = {};  ///< to go on from; none: from the beginning
};

class LearnerProcess {
 public:
  /// Takes the run's folder and subscribes. `bus` must outlive the process.
  LearnerProcess(const Experiment& experiment, Bus& bus, LearnerOptions options);

  /// Returns whether the training was completed; otherwise it was interrupted, by a signal or for want of
  /// episodes. Results are written in any case, and a checkpoint if the training or the search for the
  /// optimum was cut short.
  bool Run();

 private:
  TrainerOutput Output();
  void RefuseTakenBus();
  void Serve(std::stop_token stop);
  void Train();
  bool GivesUp() const;
  void BeginTraining();
  void WriteCheckpointIfDue();
  void WriteCheckpoint();
  void WaitForOptimum();
  void Report();
  void WriteResults();
  double WallSeconds() const;

  Experiment experiment_;
  World world_;
  LearnerOptions options_;
  Bus* bus_;
  LearnerNode node_;
  Trainer trainer_;
  RunFolder folder_;
  int resumptions_ = 0;
  std::optional<OptimumSearch> optimum_;  // from the run's beginning
  std::exception_ptr network_error_;
  int64_t begin_us_ = 0;
  double wall_before_s_ = 0;  // of the training before it was resumed
  double wall_s_ = 0;         // of the training
  int64_t next_checkpoint_us_ = 0;
  CheckpointFigures checkpoints_;
};

}  // namespace fresco
