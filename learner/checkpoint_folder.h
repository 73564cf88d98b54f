// The checkpoints of a run's folder: DIR/checkpoints/ORDERS.checkpoint, the last few kept. Writing is
// the file writer's work; reading takes the latest whole one.
#pragma once

#include <cstdint>
#include <filesystem>
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

  /// The latest one that is whole; what is wrong with later ones is said in the log. None: there is no
  /// checkpoint at all. Throws UsageError where there are some and none is whole.
  std::optional<Checkpoint> ReadLatest() const;

 private:
  std::filesystem::path directory_;
};

}  // namespace fresco
