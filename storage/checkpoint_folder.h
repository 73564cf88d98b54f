// The checkpoints of a run's folder: DIR/checkpoints/ORDERS.checkpoint (twelve digits), the last few kept.
// Writing is the file writer's work; reading takes the latest usable one. Files of other names are none of
// its business.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "storage/checkpoint_file.h"

namespace fresco {

/// A checkpoint that a run can't go on from, and why.
struct UnusableCheckpoint {
  std::filesystem::path path;
  std::string problem;
};

/// Renames them to NAME.unusable (in place of older ones of that name), so that they count as none of those
/// that CheckpointFolder::Prune keeps, and says so in the log. The caller holds the folder's lock. Throws
/// Failure if one can't be renamed.
void SetAside(const std::vector<UnusableCheckpoint>& checkpoints);

class CheckpointFolder {
 public:
  /// Of the run's folder `run`, which need not have any.
  explicit CheckpointFolder(const std::filesystem::path& run) : directory_(run / "checkpoints") {}

  /// Where the checkpoint of this moment belongs.
  std::filesystem::path PathFor(int64_t committed_orders) const;

  /// Throws Failure where the folder can't be made.
  void Make() const;

  /// Deletes all but the latest `kept`.
  void Prune(int kept) const;

  /// Every checkpoint, latest first.
  std::vector<std::filesystem::path> Latest() const;

  /// Throws UsageError with the reason where a whole checkpoint, read from the file, can't be used.
  using Check = std::function<void(const Checkpoint&, const std::filesystem::path&)>;

  /// What a run can go on from.
  struct Found {
    std::optional<Checkpoint> checkpoint = {};      ///< none: there is no checkpoint at all
    std::vector<UnusableCheckpoint> unusable = {};  ///< those that are later than this one
  };

  /// Finds the latest checkpoint that can be read, is whole and passes the check. Throws UsageError if there
  /// are some and none is usable. Changes nothing. The caller holds the folder's lock.
  Found FindLatest(const Check& check) const;

 private:
  std::filesystem::path directory_;
};

}  // namespace fresco
