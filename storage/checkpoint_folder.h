// The checkpoint files of a run's folder, and what is needed to resume the run from the latest usable one.
// They are DIR/checkpoints/ORDERS.checkpoint; ORDERS is the number of committed orders in twelve digits.
// FileWriter writes them. Files with other names are ignored. Different threads may use different objects.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "storage/checkpoint_file.h"

namespace fresco {

/// A checkpoint from which a run can't continue, and why.
struct UnusableCheckpoint {
  std::filesystem::path path;
  std::string problem;
};

/// Renames each of these files to NAME.unusable, replacing older files of that name, and says so in the log.
/// So CheckpointFolder::Prune does not count them among those that it keeps. The caller holds the folder's
/// lock. Throws Failure if a file can't be renamed.
void SetAside(const std::vector<UnusableCheckpoint>& checkpoints);

class CheckpointFolder {
 public:
  /// `run` is the run's folder. It need not have checkpoints.
  explicit CheckpointFolder(const std::filesystem::path& run);

  /// The path of the checkpoint that is taken after so many committed orders.
  std::filesystem::path PathFor(int64_t committed_orders) const;

  /// Makes the folder DIR/checkpoints. Throws Failure if it can't.
  void Make() const;

  /// Deletes all checkpoints except the latest `kept` (>= 1).
  void Prune(int kept) const;

  /// Returns the paths of all checkpoints, latest first.
  std::vector<std::filesystem::path> Latest() const;

 private:
  std::filesystem::path directory_;
};

/// What is needed to resume a run that was interrupted.
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
/// checkpoint that is complete and has the run's configuration and this program's arithmetic. `settings` may
/// change fields of `run` only. Changes nothing. The caller holds the folder's lock. Throws UsageError if the
/// folder holds no run or a complete one, or if it has checkpoints but none can be used.
Resumption ReadResumption(const std::filesystem::path& folder, const Settings& settings);

}  // namespace fresco
