#include "soak/faults.h"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <utility>

#include "core/clock.h"
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

FaultInjector::FaultInjector(const FaultPlan& plan, GuestStarter start_guest)
    : plan_(plan), start_guest_(std::move(start_guest)), next_(plan_.Next()) {}

void FaultInjector::Step(TrainingRun& run, int64_t elapsed_us, bool quiet) {
  ContinueWhere(run, [&](const Stop& stop) { return elapsed_us >= stop.until_us; });
  MindGuests(elapsed_us);
  while (!quiet && elapsed_us >= next_.at_us) {
    Inject(run, next_, elapsed_us);
    next_ = plan_.Next();
  }
}

void FaultInjector::Inject(TrainingRun& run, const Fault& fault, int64_t elapsed_us) {
  const int64_t until_us = elapsed_us + fault.duration_us;  // from now: a long resumption may have delayed
                                                            // the fault
  switch (fault.kind) {
    case FaultKind::kKillActor:
      run.SignalActor(fault.actor, SIGKILL);
      break;
    case FaultKind::kStopActor:
      run.SignalActor(fault.actor, SIGSTOP);
      stops_.push_back({fault.actor, until_us});
      break;
    case FaultKind::kKillLearner:
      run.SignalLearner(SIGKILL);
      learner_killed_ = true;
      break;
    case FaultKind::kStopLearner:
      run.SignalLearner(SIGSTOP);
      stops_.push_back({-1, until_us});
      break;
    case FaultKind::kGuestActor:
      guests_.push_back({start_guest_(), until_us, fault.ends_killed ? SIGKILL : SIGTERM});
      break;
  }
  faults_.push_back({fault, WallMicroseconds(), committed_});
}

/// Continues the processes whose stop is over. A process that was stopped twice continues when the first stop
/// is over.
void FaultInjector::ContinueWhere(TrainingRun& run, const std::function<bool(const Stop&)>& over) {
  for (const Stop& stop : stops_) {
    if (over(stop) && stop.actor < 0) {
      run.SignalLearner(SIGCONT);
    } else if (over(stop)) {
      run.SignalActor(stop.actor, SIGCONT);
    }
  }
  std::erase_if(stops_, over);
}

void FaultInjector::Continue(TrainingRun& run) {
  ContinueWhere(run, [](const Stop&) { return true; });
}

void FaultInjector::MindGuests(int64_t elapsed_us) {
  for (Guest& guest : guests_) {
    if (!guest.told && elapsed_us >= guest.until_us && !guest.process->ExitStatus()) {
      guest.process->Signal(guest.leaves_by);
      guest.told = true;
    }
    if (const auto status = guest.process->ExitStatus()) {
      NoteGuestEnd(guest, *status);
    }
  }
  std::erase_if(guests_, [](const Guest& guest) { return guest.process->ExitStatus().has_value(); });
}

void FaultInjector::EndGuests() {
  constexpr int64_t kPatienceUs = 10'000'000;
  MindGuests(0);
  for (Guest& guest : guests_) {
    guest.told = true;
    NoteGuestEnd(guest, guest.process->End(kPatienceUs));
  }
  guests_.clear();
}

std::vector<pid_t> FaultInjector::GuestPids() const {
  std::vector<pid_t> pids;
  for (const Guest& guest : guests_) {
    pids.push_back(guest.process->pid());
  }
  return pids;
}

void FaultInjector::NoteGuestEnd(const Guest& guest, int status) {
  // If it gets the signal before it has installed its handlers, it ends by the signal itself.
  const bool as_told = guest.told && (status == 0 || status == 128 + SIGTERM ||
                                      (guest.leaves_by == SIGKILL && status == 128 + SIGKILL));
  if (!as_told) {
    guest_failure_ = fmt::format("an actor that had joined the run ended {} with exit status {}",
                                 guest.told ? "when it was told to leave" : "by itself", status);
  }
}

void FaultInjector::NoteProgress(int64_t committed_orders, int64_t wall_us) {
  committed_ = std::max(committed_, committed_orders);
  for (InjectedFault& fault : faults_) {
    if (!fault.recovery_s && wall_us > fault.wall_us && committed_orders > fault.committed_before) {
      fault.recovery_s = 1e-6 * static_cast<double>(wall_us - fault.wall_us);
    }
  }
}

void FaultInjector::NoteEnd(int64_t wall_us) {
  NoteProgress(INT64_MAX, wall_us);
}

bool FaultInjector::TakeLearnerKill() {
  return std::exchange(learner_killed_, false);
}

}  // namespace fresco
