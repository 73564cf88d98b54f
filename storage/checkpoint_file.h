// A checkpoint on disk: a training's state with the run that it belongs to. Reading refuses torn,
// foreign and newer files. Pure but for the experiment's defaults; thread-safe.
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
  uint32_t arithmetic_fingerprint = 0;
  int64_t run_id = 0;
  TrainingState training = {};
  // What a run is reported by; has no influence on the weights.
  int resumptions = 0;
  double wall_s = 0;                             ///< of the training so far
  std::string metrics = {};                      ///< metrics.csv
  std::map<std::string, int64_t> counters = {};  ///< of the bus, by name
};

/// What a checkpoint takes of memory while it is written, at most: the state that was copied, the same as
/// Protobuf's message, its content, and the file. `parameters` of a network, `versions` of networks in
/// flight, `actions` of the replay memory.
int64_t CheckpointBytes(int64_t parameters, int64_t versions, int64_t actions);

/// The bytes of a file, with a CRC-32C. Throws Failure where they exceed 2 GB, Protobuf's limit.
std::string SerializeCheckpoint(const Checkpoint& checkpoint);

/// Whether these bytes say that they are a checkpoint, whole or not.
bool LooksLikeCheckpoint(std::string_view content);

/// Throws UsageError naming `origin` (the file) and what is wrong: not a checkpoint, cut short, damaged,
/// made by a newer Fresco, sizes that contradict its configuration. Whether the state makes sense beyond
/// its sizes is seen by Trainer::Resume.
Checkpoint ParseCheckpoint(std::string_view content, const std::string& origin);

}  // namespace fresco
