// Plans the faults of a round of a soak, and injects them into its run. Only one thread may use an object.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bus/lossy_bus.h"
#include "core/child_process.h"
#include "core/random.h"
#include "processes/training_run.h"

namespace fresco {

/// Kill: SIGKILL. Stop: SIGSTOP, and SIGCONT later. Guest: a further actor joins for some time.
enum class FaultKind { kKillActor, kStopActor, kKillLearner, kStopLearner, kGuestActor };
inline constexpr std::array kFaultKinds = {FaultKind::kKillActor, FaultKind::kStopActor,
                                           FaultKind::kKillLearner, FaultKind::kStopLearner,
                                           FaultKind::kGuestActor};

/// "kill_actor", "stop_actor", …
const char* FaultKindName(FaultKind kind);

struct Fault {
  int64_t at_us = 0;  ///< time of the fault after the beginning of the round
  FaultKind kind = FaultKind::kKillActor;
  int actor = -1;            ///< number of the local actor, 0, 1, ..; -1: the fault concerns none
  int64_t duration_us = 0;   ///< length of a stop or of a guest's stay; 0 for a kill
  bool ends_killed = false;  ///< for a guest: it ends by SIGKILL instead of SIGTERM

  friend bool operator==(const Fault&, const Fault&) = default;
};

/// What happens to a run in one round: an endless sequence of faults, and the disturbance of its messages.
/// The plan is a pure function of seed, round and number of actors, so a round can be repeated.
class FaultPlan {
 public:
  static constexpr int64_t kShortestGapUs = 200'000;
  static constexpr int64_t kLongestGapUs = 1'400'000;

  /// `round` is 1, 2, ..; `actors` (>= 1) is the number of local actors.
  FaultPlan(uint64_t seed, int round, int actors);

  /// Loss, repetition, delay and corruption of all messages that are sent in this round.
  const LossOptions& disturbance() const { return disturbance_; }

  /// Returns the next fault, kShortestGapUs to kLongestGapUs after the one before. Of every five faults, one
  /// is of each kind, in random order.
  Fault Next();

 private:
  int64_t DrawBetween(int64_t low, int64_t high);
  void FillBag();

  RandomStream stream_;
  uint32_t actors_;
  LossOptions disturbance_;
  int64_t at_us_ = 0;
  std::vector<FaultKind> bag_;  // the kinds that are left for the present five faults
};

/// A fault that was injected.
struct InjectedFault {
  Fault fault;
  int64_t wall_us = 0;                    ///< time of the fault, microseconds since the epoch
  int64_t committed_before = 0;           ///< orders committed before the fault
  std::optional<double> recovery_s = {};  ///< time until the learner reported more committed orders; none: it
                                          ///< did not
};

/// Injects the faults of a plan, and measures how long the run takes to recover from each. One round of a
/// soak owns one.
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

  /// Notes that the learner reported so many committed orders at `wall_us`.
  void NoteProgress(int64_t committed_orders, int64_t wall_us);
  /// Notes that the run was completed at `wall_us`, so it has recovered from all faults.
  void NoteEnd(int64_t wall_us);

  /// Returns whether a learner was killed since the last call.
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
