// Reads what is needed to resume a run that was interrupted: its configuration and its latest usable
// checkpoint.
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
  std::optional<Checkpoint> checkpoint;      ///< none: the run begins again with its first order
  std::vector<UnusableCheckpoint> unusable;  ///< later checkpoints that can't be used; the learner calls
                                             ///< SetAside
};

/// How long to wait for the lock of a folder to resume, since a learner that is about to end may still be
/// writing, microseconds.
inline constexpr int64_t kResumePatienceUs = 5'000'000;

/// Reads the folder of a run that is incomplete or whose search for the optimum was stopped. Finds the latest
/// checkpoint that is whole and has the run's configuration and this program's arithmetic. `settings` may
/// change fields of `run` only. Changes nothing. The caller holds the folder's lock. Any thread may call it.
/// Throws UsageError if the folder holds no run or a complete one, or if it has checkpoints but none can be
/// used.
Resumption ReadResumption(const std::filesystem::path& folder, const Settings& settings);

}  // namespace fresco
