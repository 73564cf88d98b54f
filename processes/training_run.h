// Checks a run, and starts, watches and ends its processes: a learner and its local actors. `train` has one
// run, `figures` and `soak` have several.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bus/open_bus.h"
#include "core/child_process.h"
#include "msgs/experiment.h"
#include "msgs/message_bus.h"
#include "processes/restart_policy.h"
#include "processes/run_recorder.h"
#include "storage/checkpoint_folder.h"
#include "storage/run_folder.h"

namespace fresco {

// ---- Checks before anything is written or started, so that wrong use leaves no folder, file or process
// behind. Any thread may call these functions.

/// Throws UsageError if a program of the run is missing, or if this host has too little memory for the
/// learner or the local actors, alone or together. Further checks of an experiment that are possible before
/// it runs belong here.
void CheckRun(const Experiment& experiment);

/// Does CheckRun, and opens and closes the bus of the experiment. For commands with many runs. Throws as
/// CheckRun and OpenBus do.
void CheckRunAndBus(const Experiment& experiment, const BusOptions& bus_options);

/// Reads what is needed to resume the run in `folder`. Waits for a learner that is about to end there. Throws
/// as ReadResumption does, and if a learner is working in the folder.
Resumption ReadInterruptedRun(const std::filesystem::path& folder, const Settings& settings = {});

/// Returns the command that starts an actor which serves this run, or any run on its channels if there is no
/// id.
std::vector<std::string> ActorCommand(const Experiment& experiment, const BusOptions& bus_options,
                                      std::optional<int64_t> run_id = {});

/// Only one thread may use an object.
class TrainingRun {
 public:
  /// Prepares a new run in `folder`: does CheckRun, checks the folder, and opens the bus. Nothing is written
  /// before Start. Every process gets `bus_options`; if they disturb messages, each with a seed of its own.
  /// Throws UsageError.
  TrainingRun(const Experiment& experiment, std::filesystem::path folder, const BusOptions& bus_options = {});
  /// Does the same for resuming the run in `folder`, which ReadResumption has read.
  TrainingRun(const Resumption& resumption, std::filesystem::path folder, const BusOptions& bus_options = {});
  /// Ends every process that is still running.
  ~TrainingRun() = default;

  /// Call it before Start to record the run's traffic until End, in files of `split_mb` megabytes unless that
  /// is 0.
  void Record(double split_mb) { record_split_mb_ = split_mb; }

  /// Makes the folder and starts recorder and learner. Throws if the folder can't be made or the traffic
  /// can't be recorded.
  void Start();

  /// Waits at most `timeout_us` for a status, and starts actors again that have ended. Returns whether the
  /// learner is still running. Throws Failure with an actor's own words if actors can't start, and if the
  /// learner has sent nothing for run.patience_s.
  bool Step(int64_t timeout_us);

  /// Ends the learner, then the actors. Returns the learner's exit status; 0 if the run is complete.
  int End();

  int64_t run_id() const { return run_id_; }
  /// The bus of the run, which Step polls.
  Bus& bus() { return *bus_; }

  // ---- For `soak`, which disturbs and watches a run.
  /// Sends a signal to the learner, or to the actor `number` (0 .. run.actors - 1). Does nothing if
  /// there is no such process at the moment.
  void SignalLearner(int signal_number);
  void SignalActor(int number, int signal_number);
  /// The ids of the processes that have started and not been seen to end, the learner's first.
  std::vector<pid_t> Pids() const;
  /// How often a local actor ended by itself: with an error, or by a signal that `soak` does not send.
  int actor_failures() const { return actor_failures_; }

  /// The learner's last status; none before the first.
  const std::optional<learner_status_t>& status() const { return status_; }
  /// Seconds since the learner's last status, of which it should send five a second, or since its start.
  double SilentSeconds() const;

  /// Returns the summary that the learner has written, as JSON. Throws with the last lines of the learner's
  /// log if it has written none.
  std::string Summary() const;

  /// Returns RunRecorder::Report; empty if nothing was to be recorded. Call it after End.
  std::string RecordingReport() const { return recorder_ ? recorder_->Report() : ""; }

  /// Returns the command that continues this run after an interruption, with the same key file and recording.
  std::string ResumeCommand() const;

 private:
  /// One local actor, whose process may be replaced.
  struct LocalActor {
    std::unique_ptr<ChildProcess> process;
    RestartPolicy restarts;
    int64_t start_at_us = 0;
  };

  TrainingRun(const Experiment& experiment, std::filesystem::path folder, const BusOptions& bus_options,
              RunFolder::Use use, int64_t run_id);
  void PrepareFolder() const;
  void Listen();
  std::vector<std::string> LearnerCommand();
  BusOptions NextBusOptions();
  void KeepActorsAlive();
  void GiveUpOnASilentLearner() const;
  void NoteDeath(LocalActor& actor, const std::filesystem::path& log, int64_t now_us);
  void EndActors();

  Experiment experiment_;
  std::filesystem::path folder_;
  BusOptions bus_options_;
  RunFolder::Use use_;
  int64_t run_id_;
  std::optional<double> record_split_mb_;  // none: nothing is recorded
  std::unique_ptr<Bus> bus_;
  std::optional<MessageBus> messages_;  // over bus_
  std::optional<learner_status_t> status_;
  int64_t heard_us_ = 0;                   // time of the learner's last status, or of its start
  std::unique_ptr<RunRecorder> recorder_;  // declared before learner and actors, so that it ends after them
  std::unique_ptr<ChildProcess> learner_;
  std::vector<LocalActor> actors_;
  uint64_t started_processes_ = 0;
  int actor_failures_ = 0;
};

}  // namespace fresco
