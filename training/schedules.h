// What the schedule says of each episode and update of a run: seed, epsilon, learning rate. Pure.
#pragma once

#include <cstdint>

#include "msgs/proto/experiment.pb.h"

namespace fresco {

/// Seed of a training episode's random streams. `seed` is the run's, `episode` counts the training episodes
/// from 0; evaluations do not count, so they have no influence on what is learned.
uint64_t EpisodeSeed(uint64_t seed, int64_t episode);

/// Epsilon of a training episode (0, 1, ..) that is ordered when `transitions` were committed.
double EpsilonOf(const proto::Schedule& schedule, int64_t episode, int64_t transitions);

/// Learning rate of the next update, after `updates` updates and `episodes` committed episodes.
/// `expected_updates` of the whole run is the span of the linear decay.
double LearningRateOf(const proto::Agent& agent, int64_t updates, int64_t episodes, int64_t expected_updates);

/// Updates of a run whose every episode lasts `transitions_per_episode` transitions.
int64_t ExpectedUpdates(const proto::Schedule& schedule, int transitions_per_episode);

}  // namespace fresco
