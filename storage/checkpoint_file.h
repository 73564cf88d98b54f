// Converts checkpoints to the bytes of a file and back. A checkpoint is the state of a training together with
// the run that it belongs to. Parsing refuses damaged and foreign files and those of a newer version. Pure
// functions; any thread may call them.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "msgs/experiment.h"
#include "training/training_state.h"

namespace fresco {

struct Checkpoint {
  Experiment experiment;
  uint32_t arithmetic_fingerprint = 0;  ///< ArithmeticFingerprint() of the learner
  int64_t run_id = 0;
  TrainingState training = {};
  // The remaining members are for reports. They have no influence on the weights.
  int resumptions = 0;                           ///< how often the run was resumed before
  double wall_s = 0;                             ///< wall time of the training so far, seconds
  std::string metrics = {};                      ///< the text of metrics.csv so far
  std::map<std::string, int64_t> counters = {};  ///< the bus counters so far, by name
};

/// The most memory that a checkpoint takes while it is written, bytes: the copied state, the same as
/// Protobuf's message, its serialized content, and the file. `parameters` is the number of values of a
/// network, `versions` the number of network versions in the checkpoint, `episode_bytes` the memory of the
/// episodes in the replay memory.
int64_t CheckpointBytes(int64_t parameters, int64_t versions, int64_t episode_bytes);

/// The bytes of the replay memory's episodes in a checkpoint, if they have so many transitions.
int64_t CheckpointedEpisodeBytes(const World& world, int64_t transitions);

/// Returns the bytes of a checkpoint file. Throws Failure if they exceed 2 GB, Protobuf's limit.
std::string SerializeCheckpoint(const Checkpoint& checkpoint);

/// Whether the bytes begin like a checkpoint file. They may still be damaged or incomplete.
bool LooksLikeCheckpoint(std::string_view content);

/// Parses the bytes of a checkpoint file. Throws UsageError that names `origin` (the file) and what is wrong:
/// it is not a checkpoint, is cut short or damaged, was made by a newer Fresco, or has sizes that contradict
/// its configuration. Only sizes are checked here; Trainer::Resume checks the rest of the state.
Checkpoint ParseCheckpoint(std::string_view content, const std::string& origin);

}  // namespace fresco
