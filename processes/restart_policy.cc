#include "processes/restart_policy.h"

#include <algorithm>
#include <csignal>
#include <utility>

#include "core/error.h"

namespace fresco {

bool RestartPolicy::EndedByOthers(int exit_status) {
  return exit_status == 128 + SIGKILL || exit_status == 128 + SIGTERM;
}

int64_t RestartPolicy::NoteDeath(int exit_status, int64_t lived_us) {
  const bool in_plugin = exit_status == static_cast<int>(ErrorKind::kPlugin);
  if (lived_us >= (in_plugin ? kEarlyInPluginUs : kEarlyUs)) {
    *this = RestartPolicy();
    return 0;
  }
  own_ends_ = EndedByOthers(exit_status) ? 0 : own_ends_ + 1;
  return std::exchange(next_pause_us_, std::min(kLongestPauseUs, 2 * next_pause_us_));
}

}  // namespace fresco
