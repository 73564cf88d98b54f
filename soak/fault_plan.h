// Plans what happens to a run in one round of a soak: an endless sequence of faults, and the disturbance of
// its messages. The plan is a pure function of seed, round and number of actors, so a round can be repeated.
// Only one thread may use an object.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bus/lossy_bus.h"
#include "core/random.h"

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

}  // namespace fresco
