// Episodes from their actions: the environment is deterministic, so states, rewards, masks and outcome
// follow from them. Pure.
#pragma once

#include <span>

#include "msgs/episode.h"

namespace fresco {

/// Whether the transitions of `run` are, to the bit, those at their place in `episode`, and it says of the
/// outcome what a run there has to say. Temporal-difference errors do not count: they depend on networks,
/// too.
bool IsPartOf(const Episode& run, const Episode& episode);

/// Flies the first of `actions` until the episode ends. Its order index is 0 and its temporal-difference
/// errors are 0. Returns false where an action is not allowed or the episode does not end with them.
bool FlyActions(const World& world, MaskOptions mask_options, std::span<const int16_t> actions,
                Episode& episode);

}  // namespace fresco
