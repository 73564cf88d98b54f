// What a run that did not end goes on from: its folder's configuration and latest whole checkpoint.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "msgs/checkpoint_file.h"
#include "msgs/experiment.h"

namespace fresco {

struct Resumption {
  Experiment experiment;
  std::optional<Checkpoint> checkpoint;  ///< none: the run goes on from its beginning
};

/// For the lock of a folder that is to be resumed: a learner that was told to end may still be writing.
inline constexpr int64_t kResumePatienceUs = 5'000'000;

/// Reads the folder of an incomplete run, or of one whose search for the optimum was stopped; the caller
/// holds its lock. The settings may change `run` only. Takes the latest checkpoint that is whole, of this
/// configuration and of this program's arithmetic, and renames later ones (learner/checkpoint_folder.h).
/// Throws UsageError where the folder holds no run or a complete one, or has checkpoints of which none is
/// usable.
Resumption ReadResumption(const std::filesystem::path& folder, const Settings& settings);

}  // namespace fresco
