// What a configuration makes an actor take of memory. Pure.
#pragma once

#include "core/memory_need.h"
#include "msgs/experiment.h"

namespace fresco {

/// Of one actor, at most: with every order of the window, and `capacity` environments.
MemoryNeed ActorMemory(const Experiment& experiment, int capacity);

}  // namespace fresco
