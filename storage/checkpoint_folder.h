// Manages the checkpoint files of a run's folder: DIR/checkpoints/ORDERS.checkpoint, where ORDERS is the
// number of committed orders in twelve digits. Finds the latest usable one and deletes old ones; FileWriter
// writes them. Ignores files with other names. Different threads may use different objects.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
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
  explicit CheckpointFolder(const std::filesystem::path& run) : directory_(run / "checkpoints") {}

  /// The path of the checkpoint that is taken after so many committed orders.
  std::filesystem::path PathFor(int64_t committed_orders) const;

  /// Makes the folder DIR/checkpoints. Throws Failure if it can't.
  void Make() const;

  /// Deletes all checkpoints except the latest `kept` (>= 1).
  void Prune(int kept) const;

  /// Returns the paths of all checkpoints, latest first.
  std::vector<std::filesystem::path> Latest() const;

  /// A function that throws UsageError with the reason if a checkpoint that was read from this path can't be
  /// used.
  using Check = std::function<void(const Checkpoint&, const std::filesystem::path&)>;

  /// The checkpoint from which a run can continue.
  struct Found {
    std::optional<Checkpoint> checkpoint = {};      ///< none: the folder has no checkpoint at all
    std::vector<UnusableCheckpoint> unusable = {};  ///< later checkpoints, which can't be used
  };

  /// Finds the latest checkpoint that can be read, is whole and passes the check. Throws UsageError if there
  /// are checkpoints, but none can be used. Changes nothing. The caller holds the folder's lock.
  Found FindLatest(const Check& check) const;

 private:
  std::filesystem::path directory_;
};

}  // namespace fresco
