// Decides when to start a process again after it has ended: at once if it had run for a while, and after a
// growing pause if it ended early: right after its start, or in code that is not Fresco's. If it ends early
// again and again, it is hopeless. Uses no clock; times are arguments. TrainingRun owns one for each actor.
// Only one thread may use an object.
#pragma once

#include <cstdint>

namespace fresco {

class RestartPolicy {
 public:
  /// A process that ran for less than this ended early; so did one that ended with the status of
  /// ErrorKind::kPlugin before kEarlyInPluginUs.
  static constexpr int64_t kEarlyUs = 2'000'000;
  static constexpr int64_t kEarlyInPluginUs = 60'000'000;
  static constexpr int64_t kFirstPauseUs = 100'000;
  static constexpr int64_t kLongestPauseUs = 5'000'000;
  /// It is hopeless if so many processes in succession ended by themselves, and early.
  static constexpr int kHopelessAfter = 5;

  /// Whether somebody else ended the process, by SIGKILL or SIGTERM. Such an end says nothing about the next
  /// process. `exit_status` is that of ChildProcess::ExitStatus.
  static bool EndedByOthers(int exit_status);

  /// Notes that a process ended after `lived_us`, and returns the pause before the next start,
  /// microseconds.
  int64_t NoteDeath(int exit_status, int64_t lived_us);

  /// Whether the process apparently can't start.
  bool hopeless() const { return own_ends_ >= kHopelessAfter; }

 private:
  int64_t next_pause_us_ = kFirstPauseUs;
  int own_ends_ = 0;  // processes in succession that ended by themselves, and early
};

}  // namespace fresco
