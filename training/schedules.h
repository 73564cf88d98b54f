// Computes the seed and the epsilon of each training episode and the learning rate of each update from the
// configuration. Pure functions; any thread may call them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "msgs/proto/experiment.pb.h"

namespace fresco {

/// The seed of a training episode's random draws. `seed` is schedule.seed; `episode` is the episode's number
/// among the training episodes, 0, 1, .. Evaluations are not counted, so they have no influence on the
/// training.
uint64_t EpisodeSeed(uint64_t seed, int64_t episode);
/// The same for evaluation episodes, which are counted for themselves.
uint64_t EvaluationSeed(uint64_t seed, int64_t episode);

/// The seeds of the episodes that every evaluation flies if schedule.fixed_evaluation_episodes is true.
std::vector<uint64_t> FixedEvaluationSeeds(const proto::Schedule& schedule);
/// Then the seeds of those that judge the version that is delivered. No evaluation before had them.
std::vector<uint64_t> FixedDeliverySeeds(const proto::Schedule& schedule);

/// The first transition whose action a beam search chooses in training episode number `episode`, 0 ..
/// longest_episode - 1, or none if that episode does not search. Most begin early.
std::optional<int> SearchedFrom(const proto::Schedule& schedule, int64_t episode, int longest_episode);

/// The epsilon, 0 .. 1, of training episode number `episode` (0, 1, ..), if its order is written when
/// `transitions` transitions are committed.
double EpsilonOf(const proto::Schedule& schedule, int64_t episode, int64_t transitions);

/// The learning rate of the next update, after `updates` updates and `episodes` committed training episodes.
/// A linear decay ends after `expected_updates` (>= 1) updates.
double LearningRateOf(const proto::Agent& agent, int64_t updates, int64_t episodes, int64_t expected_updates);

/// The number of updates, at least 1, of a run in which every episode has `transitions_per_episode`
/// transitions.
int64_t ExpectedUpdates(const proto::Schedule& schedule, int transitions_per_episode);

}  // namespace fresco
