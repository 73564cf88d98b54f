#include "tools/restart_policy.h"

#include <algorithm>
#include <csignal>
#include <utility>

namespace fresco {

int64_t RestartPolicy::NoteDeath(int exit_status, int64_t lived_us) {
  if (lived_us >= kEarlyUs) {
    *this = RestartPolicy();
    return 0;
  }
  const bool ended_by_others = exit_status == 128 + SIGKILL || exit_status == 128 + SIGTERM;
  own_ends_ = ended_by_others ? 0 : own_ends_ + 1;
  return std::exchange(next_pause_us_, std::min(kLongestPauseUs, 2 * next_pause_us_));
}

}  // namespace fresco
