// Checks a whole episode against the world: the environment is deterministic, so states, rewards,
// masks and outcome follow from the actions. What does not follow is refused. Pure.
#pragma once

#include "msgs/episode.h"

namespace fresco {

/// Whether `episode` begins at the start, every state, reward and mask is what the environment gives
/// for its actions, every action was allowed, and it ends exactly where its last transition ends it.
bool FollowsFromItsActions(const World& world, MaskOptions mask_options, const Episode& episode);

}  // namespace fresco
