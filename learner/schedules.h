// Epsilon and learning rate over a run, as the configuration says. Pure.
#pragma once

#include <cstdint>

#include "msgs/proto/experiment.pb.h"

namespace fresco {

/// Epsilon of a training episode (0, 1, ..) that is ordered when `transitions` were committed.
double EpsilonOf(const proto::Schedule& schedule, int64_t episode, int64_t transitions);

/// Learning rate of the next update, after `updates` updates and `episodes` committed episodes.
/// `expected_updates` of the whole run is the span of the linear decay.
double LearningRateOf(const proto::Agent& agent, int64_t updates, int64_t episodes, int64_t expected_updates);

/// Updates of a run whose every episode lasts `transitions_per_episode` transitions.
int64_t ExpectedUpdates(const proto::Schedule& schedule, int transitions_per_episode);

}  // namespace fresco
