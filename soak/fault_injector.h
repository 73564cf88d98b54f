// Injects the faults of a FaultPlan into a run, and measures how long the run takes to recover from each. One
// round of a soak owns one. Only one thread may use it.
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

/// A fault that was injected.
struct InjectedFault {
  Fault fault;
  int64_t wall_us = 0;                    ///< time of the fault, microseconds since the epoch
  int64_t committed_before = 0;           ///< orders committed before the fault
  std::optional<double> recovery_s = {};  ///< time until the learner reported more committed orders; none: it
                                          ///< did not
};

class FaultInjector {
 public:
  /// Starts a guest: an actor that is not one of the run's local actors.
  using GuestStarter = std::function<std::unique_ptr<ChildProcess>()>;

  FaultInjector(const FaultPlan& plan, GuestStarter start_guest);

  /// Injects and ends the faults that are due `elapsed_us` after the beginning of the round. If `quiet` is
  /// set, injects no new ones.
  void Step(TrainingRun& run, int64_t elapsed_us, bool quiet);

  /// Continues all stopped processes. Call it before ending the processes.
  void Continue(TrainingRun& run);
  /// Ends the guests and waits for them.
  void EndGuests();
  /// The process ids of the guests that are running.
  std::vector<pid_t> GuestPids() const;

  /// Takes note that the learner reported so many committed orders at `wall_us`.
  void NoteProgress(int64_t committed_orders, int64_t wall_us);
  /// Takes note that the run was completed at `wall_us`, so it has recovered from all faults.
  void NoteEnd(int64_t wall_us);

  /// Whether a learner was killed since the last call.
  bool TakeLearnerKill();

  const std::vector<InjectedFault>& faults() const { return faults_; }
  /// Describes a guest that ended by itself or with a wrong exit status; empty if there was none.
  const std::string& guest_failure() const { return guest_failure_; }

 private:
  struct Stop {
    int actor;  // -1: the learner
    int64_t until_us;
  };
  struct Guest {
    std::unique_ptr<ChildProcess> process;
    int64_t until_us;
    int leaves_by;      // the signal that ends it
    bool told = false;  // whether it was sent that signal
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
  int64_t committed_ = 0;  // the most committed orders that the learner has reported
  bool learner_killed_ = false;
  std::string guest_failure_;
};

}  // namespace fresco
