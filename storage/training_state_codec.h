// Converts the state of a training to the message Checkpoint (msgs/proto/checkpoint.proto) and back. Pure
// functions; any thread may call them.
#pragma once

#include <cstdint>
#include <string>

#include "msgs/proto/checkpoint.pb.h"
#include "training/training_state.h"

namespace fresco {

/// Sets the fields of `to` that hold the state.
void WriteTrainingState(const TrainingState& from, proto::Checkpoint& to);

/// Reads the state of a training whose networks have `parameters` values. Throws UsageError that names
/// `origin` and the field if a size or an action is wrong.
TrainingState ReadTrainingState(const proto::Checkpoint& from, int64_t parameters, const std::string& origin);

}  // namespace fresco
