// Does to a run what a FaultPlan says, and measures how long the run takes to recover. Used by one thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/child_process.h"
#include "processes/training_run.h"
#include "soak/fault_plan.h"

namespace fresco {

/// A fault that took place.
struct InjectedFault {
  Fault fault;
  int64_t wall_us = 0;                    ///< when, since the epoch
  int64_t committed_before = 0;           ///< orders
  std::optional<double> recovery_s = {};  ///< until the learner reported more committed orders than before
};

class FaultInjector {
 public:
  /// Starts the actor that joins from outside.
  using GuestStarter = std::function<std::unique_ptr<ChildProcess>()>;

  FaultInjector(const FaultPlan& plan, GuestStarter start_guest);

  /// Does what is due `elapsed_us` after the round's beginning; with `quiet`, only what ends a fault.
  void Step(TrainingRun& run, int64_t elapsed_us, bool quiet);

  /// Lets everything that is stopped go on; before the processes are told to end.
  void Continue(TrainingRun& run);
  /// Sends the guests away and waits for them.
  void EndGuests();
  /// Of the actors that have joined from outside.
  std::vector<pid_t> GuestPids() const;

  /// The learner reported, at `wall_us`, so many committed orders.
  void NoteProgress(int64_t committed_orders, int64_t wall_us);
  /// The run came to its end: everything has recovered.
  void NoteEnd(int64_t wall_us);

  /// Whether a learner was killed since this was last asked.
  bool TakeLearnerKill();

  const std::vector<InjectedFault>& faults() const { return faults_; }
  /// A guest that ended by itself, or not as it was told; empty: none.
  const std::string& guest_failure() const { return guest_failure_; }

 private:
  struct Stop {
    int actor;  // -1: the learner
    int64_t until_us;
  };
  struct Guest {
    std::unique_ptr<ChildProcess> process;
    int64_t until_us;
    int leaves_by;  // signal
    bool told = false;
  };

  void Inject(TrainingRun& run, const Fault& fault, int64_t elapsed_us);
  void ContinueWhere(TrainingRun& run, const std::function<bool(const Stop&)>& over);
  void MindGuests(int64_t elapsed_us);
  void NoteGuestEnd(const Guest& guest, int status);

  FaultPlan plan_;
  GuestStarter start_guest_;
  Fault next_;
  std::vector<InjectedFault> faults_;
  std::vector<Stop> stops_;
  std::vector<Guest> guests_;
  int64_t committed_ = 0;  // orders, the most that was reported
  bool learner_killed_ = false;
  std::string guest_failure_;
};

}  // namespace fresco
