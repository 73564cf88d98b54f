// Computes how much memory an actor needs for a configuration. A pure function; any thread may call it.
#pragma once

#include "core/memory.h"
#include "msgs/experiment.h"

namespace fresco {

/// Returns the most memory that one actor needs: if it flies all orders of the window, in `capacity` (>= 1)
/// environments.
MemoryNeed ActorMemory(const Experiment& experiment, int capacity);

}  // namespace fresco
