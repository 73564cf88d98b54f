#include "soak/soak_round.h"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <memory>
#include <utility>

#include "core/clock.h"
#include "core/error.h"
#include "core/signals.h"

namespace fresco {
namespace {

constexpr double kSecondsPerMicrosecond = 1e-6;

class Round {
 public:
  Round(const RoundOptions& options, const RoundProgress& show) : options_(options), show_(show) {
    bus_.key_file = options_.key_file;
    if (options_.plan) {
      bus_.disturbance = options_.plan->disturbance();
      injector_.emplace(*options_.plan, [this] { return StartGuest(); });
    }
  }

  RoundResult Run() {
    try {
      run_ = std::make_unique<TrainingRun>(options_.experiment, options_.folder, bus_);
      run_->Start();
      while (!over_ && !StopSignal::Requested()) {
        Step();
      }
      if (run_ != nullptr) {
        EndProcesses();
      }
    } catch (const Error& error) {  // becomes part of the soak's report
      Fail(error.what());
    }
    run_.reset();  // it is still set after an error
    CloseBooks();
    return std::move(result_);
  }

 private:
  int64_t ElapsedUs() const { return MonotonicMicroseconds() - begin_us_; }
  double ElapsedSeconds() const { return kSecondsPerMicrosecond * static_cast<double>(ElapsedUs()); }

  void Step() {
    constexpr int64_t kPollUs = 20'000;
    const bool running = run_->Step(kPollUs);
    ReadStatus();
    watch_.Look(Pids());
    if (!running) {
      GoOnOrEnd();
    } else if (injector_) {
      injector_->Step(*run_, ElapsedUs(), ElapsedSeconds() > options_.faults_s);
    }
    if (!over_ && ElapsedSeconds() > options_.limit_s) {
      FailAsHung();
    }
    show_(last_status_ ? &*last_status_ : nullptr, injector_ ? injector_->faults().size() : 0);
  }

  std::vector<pid_t> Pids() const {
    std::vector<pid_t> pids = run_->Pids();
    if (injector_) {
      const std::vector<pid_t> guests = injector_->GuestPids();
      pids.insert(pids.end(), guests.begin(), guests.end());
    }
    return pids;
  }

  void ReadStatus() {
    const auto& status = run_->status();
    if (!status || (last_status_ && status->utime <= last_status_->utime)) {
      return;
    }
    last_status_ = status;
    if (status->committed_orders > committed_) {
      committed_ = status->committed_orders;
      NotePause();
    }
    if (injector_) {
      injector_->NoteProgress(status->committed_orders, status->utime);
    }
  }

  void NotePause() {
    const int64_t now_us = MonotonicMicroseconds();
    result_.longest_pause_s = std::max(
        result_.longest_pause_s, kSecondsPerMicrosecond * static_cast<double>(now_us - last_progress_us_));
    last_progress_us_ = now_us;
  }

  /// Called after the learner has ended. Ends the round if the run is complete, resumes it if the learner was
  /// killed on purpose, and otherwise fails.
  void GoOnOrEnd() {
    const int status = EndProcesses();
    const bool killed = injector_ && injector_->TakeLearnerKill() && status == 128 + SIGKILL;
    if (IsComplete(options_.folder)) {
      over_ = true;
      result_.facts = ReadRunFacts(options_.folder);
    } else if (killed) {
      Resume();
    } else if (!StopSignal::Requested()) {
      Fail(fmt::format("the learner ended by itself with exit status {}; its log ends with:{}", status,
                       LastLines(options_.folder / "learner.log", 3)));
    }
  }

  /// Resumes the run, as `train --resume` does.
  void Resume() {
    ++result_.resumptions;
    constexpr uint64_t kProcessesPerResumption = 1000;
    bus_.disturbance->seed += kProcessesPerResumption;
    run_ = std::make_unique<TrainingRun>(ReadInterruptedRun(options_.folder), options_.folder, bus_);
    run_->Start();
  }

  /// Ends the processes of the run and returns the learner's exit status.
  int EndProcesses() {
    if (injector_) {
      injector_->Continue(*run_);
    }
    const int status = run_->End();
    if (const int failures = run_->actor_failures(); failures > 0) {
      Fail(fmt::format("local actors ended by themselves {} times; see actor-*.log in {}", failures,
                       options_.folder.string()));
    }
    run_.reset();
    return status;
  }

  std::unique_ptr<ChildProcess> StartGuest() {
    BusOptions bus = bus_;
    bus.disturbance->seed += 500 + guests_++;
    return std::make_unique<ChildProcess>(ActorCommand(options_.experiment, bus),
                                          options_.folder / "guest.log");
  }

  void Fail(const std::string& failure) {
    over_ = true;
    result_.failures.push_back(failure);
  }

  void FailAsHung() {
    Fail(fmt::format(
        "hang: after {:.0f} s the run is not complete; {} of {} episodes, {:.0f} s without progress, the "
        "learner waits for {}",
        options_.limit_s, last_status_ ? last_status_->episodes : 0,
        last_status_ ? last_status_->total_episodes : 0,
        kSecondsPerMicrosecond * static_cast<double>(MonotonicMicroseconds() - last_progress_us_),
        last_status_ && !last_status_->waiting_for.empty() ? last_status_->waiting_for : "nothing"));
  }

  void CloseBooks() {
    result_.wall_s = ElapsedSeconds();
    result_.use = watch_.maxima();
    if (!injector_) {
      return;
    }
    injector_->EndGuests();
    if (!injector_->guest_failure().empty()) {
      Fail(injector_->guest_failure() + "; see guest.log in " + options_.folder.string());
    }
    if (result_.facts) {
      injector_->NoteEnd(WallMicroseconds());
    }
    result_.faults = injector_->faults();
  }

  const RoundOptions& options_;
  const RoundProgress& show_;
  BusOptions bus_;
  std::optional<FaultInjector> injector_;  // declared before run_, so that it ends after it
  std::unique_ptr<TrainingRun> run_;
  std::optional<learner_status_t> last_status_;
  ProcessWatch watch_;
  RoundResult result_;
  int64_t begin_us_ = MonotonicMicroseconds();
  int64_t last_progress_us_ = begin_us_;
  int64_t committed_ = 0;  // the most committed orders that the learner has reported
  uint64_t guests_ = 0;
  bool over_ = false;
};

}  // namespace

RoundResult RunRound(const RoundOptions& options, const RoundProgress& show) {
  return Round(options, show).Run();
}

}  // namespace fresco
