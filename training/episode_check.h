// Episodes from their actions: the environment is deterministic, so states, rewards, masks and outcome
// follow from them. Pure.
#pragma once

#include <span>

#include "msgs/episode.h"

namespace fresco {

/// Whether `episode` begins at the start, every state, reward and mask is what the environment gives
/// for its actions, every action was allowed, and it ends exactly where its last transition ends it.
bool FollowsFromItsActions(const World& world, MaskOptions mask_options, const Episode& episode);

/// Flies the first of `actions` until the episode ends. Its order index is 0 and its temporal-difference
/// errors are 0. Returns false where an action is not allowed or the episode does not end with them.
bool FlyActions(const World& world, MaskOptions mask_options, std::span<const int16_t> actions,
                Episode& episode);

}  // namespace fresco
