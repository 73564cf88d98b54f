// The processes of one run: a learner and its local actors, started, minded and ended in order. What
// `train` shows and `figures` runs many of. Used by one thread.
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
#include "msgs/wire.h"
#include "processes/restart_policy.h"
#include "processes/run_recorder.h"
#include "storage/resumption.h"
#include "storage/run_folder.h"

namespace fresco {

class TrainingRun {
 public:
  /// A new run in `folder`. Checks all that can be checked before it starts (processes/run_checks.h) and opens
  /// the bus; nothing is written before Start. Throws UsageError. `bus_options` go to every process, a
  /// disturbance with a seed of its own.
  TrainingRun(const Experiment& experiment, std::filesystem::path folder, const BusOptions& bus_options = {});
  /// Goes on with the run in `folder`, read by ReadResumption. The same holds.
  TrainingRun(const Resumption& resumption, std::filesystem::path folder, const BusOptions& bus_options = {});
  /// Ends every process that is still there.
  ~TrainingRun() = default;

  /// Has Start record the run's traffic until End, in files of `split_mb` megabytes unless that is 0.
  void Record(double split_mb) { record_split_mb_ = split_mb; }

  /// Makes the folder and starts recorder and learner. Throws if the folder can't be made, or the traffic not
  /// be recorded.
  void Start();

  /// Waits for a status, at most `timeout_us`, and starts again what has died. Returns whether the
  /// learner is still running. Throws Failure with the actor's own words where one can never start, and
  /// where the learner has said nothing for run.patience_s.
  bool Step(int64_t timeout_us);

  /// Ends learner and actors in order; returns the learner's exit status, 0 where the run is complete.
  int End();

  // ---- For those who disturb and watch a run (`soak`).
  /// A signal to the learner, or to the actor in a place; nothing where there is no process now.
  void SignalLearner(int signal_number);
  void SignalActor(int place, int signal_number);
  /// The processes that were started and not seen to end, the learner first.
  std::vector<pid_t> Pids() const;
  /// How often a local actor ended by itself: with an error, or by a signal that nobody sends.
  int actor_failures() const { return actor_failures_; }

  /// The learner's last status; none before the first.
  const std::optional<learner_status_t>& status() const { return status_; }
  /// For how long the learner, which should five times a second, has said nothing.
  double SilentSeconds() const;

  /// The summary that the learner has left in the folder, as JSON. Throws with the end of the learner's
  /// log where it has left none.
  std::string Summary() const;

  /// What was recorded, as RunRecorder::Report says; empty where nothing was to be. After End.
  std::string RecordingReport() const { return recorder_ ? recorder_->Report() : ""; }

  /// What goes on with this run where it was interrupted; with its key, without which it would go on open,
  /// and recorded where it was.
  std::string ResumeCommand() const;

 private:
  /// One local actor's place.
  struct ActorPlace {
    std::unique_ptr<ChildProcess> process;
    RestartPolicy restarts;
    int64_t start_at_us = 0;
  };

  TrainingRun(const Experiment& experiment, std::filesystem::path folder, const BusOptions& bus_options,
              RunFolder::Use use, int64_t run_id);
  void PrepareFolder() const;
  void Listen();
  std::vector<std::string> LearnerArguments();
  std::vector<std::string> ActorArguments();
  std::vector<std::string> WithBusOptions(std::vector<std::string> arguments);
  std::string RunIdText() const;
  void KeepActorsAlive();
  void GiveUpOnASilentLearner() const;
  void NoteDeath(ActorPlace& place, const std::filesystem::path& log, int64_t now_us);
  void EndActors();

  Experiment experiment_;
  std::filesystem::path folder_;
  BusOptions bus_options_;
  RunFolder::Use use_;
  int64_t run_id_;
  std::optional<double> record_split_mb_;  // none: nothing is recorded
  std::unique_ptr<Bus> bus_;
  std::optional<learner_status_t> status_;
  int64_t heard_us_ = 0;                   // the learner's last status, or its start
  std::unique_ptr<RunRecorder> recorder_;  // before learner and actors: it ends after them
  std::unique_ptr<ChildProcess> learner_;
  std::vector<ActorPlace> actors_;
  uint64_t started_processes_ = 0;
  int actor_failures_ = 0;
};

/// What the run in `folder` goes on from, read once its learner has left the folder. Throws as
/// ReadResumption does, and where a learner is at work there.
Resumption ReadInterruptedRun(const std::filesystem::path& folder, const Settings& settings = {});

}  // namespace fresco
