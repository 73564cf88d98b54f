// What happens to a run in one round of a soak: an endless sequence of faults and the disturbance of its
// messages, a pure function of (seed, round, actors), so that a round can be had again. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bus/lossy_bus.h"
#include "core/random.h"

namespace fresco {

enum class FaultKind { kKillActor, kStopActor, kKillLearner, kStopLearner, kGuestActor };
inline constexpr std::array kFaultKinds = {FaultKind::kKillActor, FaultKind::kStopActor,
                                           FaultKind::kKillLearner, FaultKind::kStopLearner,
                                           FaultKind::kGuestActor};

/// "kill_actor", "stop_actor", …
const char* FaultKindName(FaultKind kind);

struct Fault {
  int64_t at_us = 0;  ///< after the round's beginning
  FaultKind kind = FaultKind::kKillActor;
  int actor = -1;            ///< the place of the actor that it befalls; -1: none
  int64_t duration_us = 0;   ///< of a stop, or of a guest's stay; 0: a kill
  bool ends_killed = false;  ///< a guest: it does not leave in order, but is killed

  friend bool operator==(const Fault&, const Fault&) = default;
};

class FaultPlan {
 public:
  static constexpr int64_t kShortestGapUs = 200'000;
  static constexpr int64_t kLongestGapUs = 1'400'000;

  /// `round` from 1 on; `actors` local actors, at least one.
  FaultPlan(uint64_t seed, int round, int actors);

  /// Loss, repetition, delay and corruption of what every process sends in this round.
  const LossOptions& disturbance() const { return disturbance_; }

  /// The next fault, later than the one before. Every kind occurs once in five faults, in a drawn order.
  Fault Next();

 private:
  int64_t DrawBetween(int64_t low, int64_t high);
  void FillBag();

  RandomStream stream_;
  uint32_t actors_;
  LossOptions disturbance_;
  int64_t at_us_ = 0;
  std::vector<FaultKind> bag_;  // kinds that this block of five has yet to have
};

}  // namespace fresco
