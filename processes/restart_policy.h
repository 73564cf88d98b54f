// When a process that died is started again: at once where it had worked for a while; after a pause that
// grows where it died right after its start; never where it can't start. Time is an argument. Used by one
// thread.
#pragma once

#include <cstdint>

namespace fresco {

class RestartPolicy {
 public:
  /// A process that lived for less died right after its start.
  static constexpr int64_t kEarlyUs = 2'000'000;
  static constexpr int64_t kFirstPauseUs = 100'000;
  static constexpr int64_t kLongestPauseUs = 5'000'000;
  /// So many processes in succession that ended by themselves right after their start: none can start.
  static constexpr int kHopelessAfter = 5;

  /// Whether a process was ended by somebody else, by SIGKILL or SIGTERM; `exit_status` as
  /// ChildProcess::ExitStatus. That says nothing about the next.
  static bool EndedByOthers(int exit_status);

  /// Notes a death and returns the pause before the next start.
  int64_t NoteDeath(int exit_status, int64_t lived_us);

  bool hopeless() const { return own_ends_ >= kHopelessAfter; }

 private:
  int64_t next_pause_us_ = kFirstPauseUs;
  int own_ends_ = 0;  // right after the start, in succession
};

}  // namespace fresco
