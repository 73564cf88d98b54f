#include "soak/fault_injector.h"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <utility>

#include "core/clock.h"

namespace fresco {

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
