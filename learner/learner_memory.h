// Computes how much memory the learner needs for a configuration. A pure function; any thread may call it.
#pragma once

#include "core/memory.h"
#include "msgs/experiment.h"

namespace fresco {

/// Returns the most memory that the learner needs: when the replay memory is full and a checkpoint is being
/// written. Small objects are left out.
MemoryNeed LearnerMemory(const Experiment& experiment);

}  // namespace fresco
