#include "storage/resumption.h"

#include <fmt/format.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "storage/checkpoint_folder.h"
#include "storage/run_folder.h"
#include "storage/summary.h"

namespace fresco {
namespace {

void RefuseCompleteRun(const std::filesystem::path& folder) {
  const auto path = folder / "summary.json";
  if (std::filesystem::exists(path) && IsFinished(ReadFile(path))) {
    throw UsageError(fmt::format("--resume: the run in {} is complete", folder.string()));
  }
}

void CheckOrigin(const Checkpoint& checkpoint, const Experiment& experiment, const std::string& path) {
  if (checkpoint.experiment.hash() != experiment.hash()) {
    throw UsageError(
        fmt::format("--resume: {} has configuration {:08x}, expected {:08x} (config.textproto and --set); "
                    "only fields of run may change when a run is resumed",
                    path, checkpoint.experiment.hash(), experiment.hash()));
  }
  if (checkpoint.arithmetic_fingerprint != ArithmeticFingerprint()) {
    throw UsageError(
        fmt::format("--resume: {} was made with arithmetic {:08x}, but this program's is {:08x}, so the "
                    "weights would have "
                    "other bits; resume with the same build on the same kind of processor",
                    path, checkpoint.arithmetic_fingerprint, ArithmeticFingerprint()));
  }
}

}  // namespace

Resumption ReadResumption(const std::filesystem::path& folder, const Settings& settings) {
  const auto config = folder / "config.textproto";
  if (!std::filesystem::exists(config)) {
    throw UsageError(
        fmt::format("--resume: {} is not the folder of a run: it has no config.textproto; name the folder "
                    "that the run was started with (--out){}",
                    folder.string(), NewestRunHint(folder, "config.textproto")));
  }
  RefuseCompleteRun(folder);
  Experiment experiment = Experiment::Load(config.string(), settings);
  const auto check = [&](const Checkpoint& checkpoint, const std::filesystem::path& path) {
    CheckOrigin(checkpoint, experiment, path.string());
  };
  CheckpointFolder::Found found = CheckpointFolder(folder).FindLatest(check);
  return {std::move(experiment), std::move(found.checkpoint), std::move(found.unusable)};
}

}  // namespace fresco
