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

#include "msgs/checkpoint_file.h"

namespace fresco {

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

  /// The latest one that can be read, is whole and passes the check. Later ones are renamed to NAME.unusable
  /// (in place of an older one of that name), so that they count as none of those that Prune keeps; the log
  /// says what is wrong with them. None: there is no checkpoint at all. Throws UsageError where there are
  /// some and none is usable; then nothing is renamed. The caller holds the folder's lock.
  std::optional<Checkpoint> TakeLatest(const Check& check) const;

 private:
  std::filesystem::path directory_;
};

}  // namespace fresco
