// What a run that did not end goes on from: its folder's configuration and latest whole checkpoint.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "msgs/experiment.h"
#include "storage/checkpoint_folder.h"

namespace fresco {

struct Resumption {
  Experiment experiment;
  std::optional<Checkpoint> checkpoint;      ///< none: the run goes on from its beginning
  std::vector<UnusableCheckpoint> unusable;  ///< later ones; the learner that goes on does SetAside
};

/// For the lock of a folder that is to be resumed: a learner that was told to end may still be writing.
inline constexpr int64_t kResumePatienceUs = 5'000'000;

/// Reads the folder of an incomplete run, or of one whose search for the optimum was stopped; the caller
/// holds its lock. The settings may change `run` only. Finds the latest checkpoint that is whole, of this
/// configuration and of this program's arithmetic. Changes nothing. Throws UsageError if the folder holds no
/// run or a complete one, or has checkpoints of which none is usable.
Resumption ReadResumption(const std::filesystem::path& folder, const Settings& settings);

}  // namespace fresco
