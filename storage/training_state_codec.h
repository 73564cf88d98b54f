// A training's state to a checkpoint's message and back. Pure; thread-safe.
#pragma once

#include <cstdint>
#include <string>

#include "msgs/proto/checkpoint.pb.h"
#include "training/training_state.h"

namespace fresco {

void WriteTrainingState(const TrainingState& from, proto::Checkpoint& to);

/// Of networks with `parameters` values. Throws UsageError naming `origin` and the field where a size or an
/// action is wrong.
TrainingState ReadTrainingState(const proto::Checkpoint& from, int64_t parameters, const std::string& origin);

}  // namespace fresco
