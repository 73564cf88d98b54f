#include "soak/fault_plan.h"

#include <utility>

#include "core/error.h"

namespace fresco {
namespace {

// The last indices of the random streams (seed, kTest, round, index). The lossy bus uses index 0.
constexpr uint32_t kFaultStream = 1;
constexpr uint32_t kDisturbanceStream = 2;

LossOptions DrawDisturbance(RandomStream stream) {
  constexpr double kMostDropped = 0.05;
  constexpr double kMostDuplicated = 0.05;
  constexpr double kMostDelayed = 0.1;
  constexpr double kMostCorrupted = 0.01;
  LossOptions options;
  options.drop = kMostDropped * stream.NextUniform();
  options.duplicate = kMostDuplicated * stream.NextUniform();
  options.delay = kMostDelayed * stream.NextUniform();
  options.corrupt = kMostCorrupted * stream.NextUniform();
  options.seed = stream.NextWord();
  return options;
}

}  // namespace

const char* FaultKindName(FaultKind kind) {
  switch (kind) {
    case FaultKind::kKillActor:
      return "kill_actor";
    case FaultKind::kStopActor:
      return "stop_actor";
    case FaultKind::kKillLearner:
      return "kill_learner";
    case FaultKind::kStopLearner:
      return "stop_learner";
    case FaultKind::kGuestActor:
      return "guest_actor";
  }
  return "unknown";
}

FaultPlan::FaultPlan(uint64_t seed, int round, int actors)
    : stream_(seed, RandomPurpose::kTest, static_cast<uint32_t>(round), kFaultStream),
      actors_(static_cast<uint32_t>(actors)),
      disturbance_(
          DrawDisturbance({seed, RandomPurpose::kTest, static_cast<uint32_t>(round), kDisturbanceStream})) {
  FRESCO_CHECK(round >= 1 && actors >= 1);
}

Fault FaultPlan::Next() {
  if (bag_.empty()) {
    FillBag();
  }
  Fault fault;
  fault.at_us = at_us_ += DrawBetween(kShortestGapUs, kLongestGapUs);
  fault.kind = bag_.back();
  bag_.pop_back();
  if (fault.kind == FaultKind::kKillActor || fault.kind == FaultKind::kStopActor) {
    fault.actor = static_cast<int>(stream_.NextBelow(actors_));
  }
  if (fault.kind == FaultKind::kStopActor) {
    fault.duration_us = DrawBetween(100'000, 3'000'000);
  } else if (fault.kind == FaultKind::kStopLearner) {
    fault.duration_us = DrawBetween(50'000, 1'000'000);
  } else if (fault.kind == FaultKind::kGuestActor) {
    fault.duration_us = DrawBetween(300'000, 3'000'000);
    fault.ends_killed = stream_.NextBelow(2) == 1;
  }
  return fault;
}

/// Draws a number from low .. high, both included.
int64_t FaultPlan::DrawBetween(int64_t low, int64_t high) {
  return low + stream_.NextBelow(static_cast<uint32_t>(high - low + 1));
}

void FaultPlan::FillBag() {
  bag_.assign(kFaultKinds.begin(), kFaultKinds.end());
  for (size_t left = bag_.size(); left > 1; --left) {
    std::swap(bag_[left - 1], bag_[stream_.NextBelow(static_cast<uint32_t>(left))]);
  }
}

}  // namespace fresco
