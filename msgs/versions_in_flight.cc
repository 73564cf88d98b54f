#include "msgs/versions_in_flight.h"

#include <algorithm>

namespace fresco {

VersionsInFlight MostVersionsInFlight(const Experiment& experiment) {
  constexpr int64_t kEnds = 2;  // the one that the oldest order names, and the final one of a run
  const proto::Schedule& schedule = experiment.schedule();
  const int64_t episodes = std::min<int64_t>(schedule.window(), schedule.episodes());
  const int64_t transitions = episodes * experiment.world().longest_episode();
  const int64_t updates = transitions / schedule.inserts_per_update() + 1;
  return {updates / schedule.updates_per_version() + kEnds,
          updates / experiment.agent().target_update_period() + kEnds};
}

}  // namespace fresco
