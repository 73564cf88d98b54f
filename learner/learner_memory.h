// What a configuration makes the learner take of memory. Pure.
#pragma once

#include "core/memory_need.h"
#include "msgs/experiment.h"

namespace fresco {

/// At most, with the replay memory full and a checkpoint being written. Exact but for what is small.
MemoryNeed LearnerMemory(const Experiment& experiment);

}  // namespace fresco
