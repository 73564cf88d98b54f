#include "storage/checkpoint_folder.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <system_error>

#include "core/error.h"
#include "core/files.h"
#include "nn/mlp.h"
#include "storage/run_folder.h"
#include "storage/summary.h"

namespace fresco {
namespace {

constexpr char kFolder[] = "checkpoints";
constexpr char kExtension[] = ".checkpoint";
constexpr char kUnusable[] = ".unusable";
constexpr int kDigits = 12;

bool IsCheckpointName(const std::filesystem::path& path) {
  const std::string stem = path.stem();
  return path.extension() == kExtension && stem.size() == kDigits &&
         std::all_of(stem.begin(), stem.end(), [](char c) { return c >= '0' && c <= '9'; });
}

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
                    "weights would have other bits; resume with the same release, built without compiler "
                    "options like -ffast-math",
                    path, checkpoint.arithmetic_fingerprint, ArithmeticFingerprint()));
  }
}

/// Finds the latest checkpoint from which the run can continue. Throws UsageError if there are checkpoints,
/// but none can be used.
void FindLatestUsable(const std::filesystem::path& folder, Resumption& found) {
  for (const std::filesystem::path& path : CheckpointFolder(folder).Latest()) {
    try {
      Checkpoint checkpoint = ParseCheckpoint(ReadFile(path), path.string());
      CheckOrigin(checkpoint, found.experiment, path.string());
      found.checkpoint = std::move(checkpoint);
      return;
    } catch (const Error& error) {
      found.unusable.push_back({path, error.what()});
    }
  }
  if (!found.unusable.empty()) {
    std::string problems;
    for (const UnusableCheckpoint& checkpoint : found.unusable) {
      problems += "\n  " + checkpoint.problem;
    }
    throw UsageError(fmt::format("{}: none of its {} checkpoints can be used:{}", (folder / kFolder).string(),
                                 found.unusable.size(), problems));
  }
}

}  // namespace

void SetAside(const std::vector<UnusableCheckpoint>& checkpoints) {
  for (const auto& [path, problem] : checkpoints) {
    const std::filesystem::path aside = path.string() + kUnusable;
    std::error_code error;
    std::filesystem::rename(path, aside, error);
    if (error) {
      throw Failure(
          fmt::format("can't rename {} to {}: {}; remove it, since later checkpoints need its place",
                      path.string(), aside.filename().string(), error.message()));
    }
    spdlog::warn("{}; renamed it to {}, continuing from an earlier checkpoint", problem,
                 aside.filename().string());
  }
}

CheckpointFolder::CheckpointFolder(const std::filesystem::path& run) : directory_(run / kFolder) {}

std::filesystem::path CheckpointFolder::PathFor(int64_t committed_orders) const {
  return directory_ / fmt::format("{:0{}}{}", committed_orders, kDigits, kExtension);
}

void CheckpointFolder::Make() const {
  std::error_code error;
  std::filesystem::create_directories(directory_, error);
  if (error) {
    throw Failure(fmt::format("can't make the folder {}: {}", directory_.string(), error.message()));
  }
}

std::vector<std::filesystem::path> CheckpointFolder::Latest() const {
  std::vector<std::filesystem::path> paths;
  std::error_code error;  // ignored: without a folder there are no checkpoints
  for (const auto& entry : std::filesystem::directory_iterator(directory_, error)) {
    if (IsCheckpointName(entry.path())) {
      paths.push_back(entry.path());
    }
  }
  std::sort(paths.begin(), paths.end(), std::greater<>());
  return paths;
}

void CheckpointFolder::Prune(int kept) const {
  const std::vector<std::filesystem::path> paths = Latest();
  for (size_t i = static_cast<size_t>(kept); i < paths.size(); ++i) {
    std::error_code error;  // ignored: a checkpoint too many does no harm
    std::filesystem::remove(paths[i], error);
  }
}

Resumption ReadResumption(const std::filesystem::path& folder, const Settings& settings) {
  const auto config = folder / "config.textproto";
  if (!std::filesystem::exists(config)) {
    throw UsageError(
        fmt::format("--resume: {} is not the folder of a run: it has no config.textproto; name the folder "
                    "that the run was started with (--out){}",
                    folder.string(), NewestRunHint(folder, "config.textproto")));
  }
  RefuseCompleteRun(folder);
  Experiment experiment = RunFolder::WithStart(Experiment::Load(config.string(), settings), folder);
  Resumption resumption{std::move(experiment), std::nullopt, {}};
  FindLatestUsable(folder, resumption);
  return resumption;
}
}  // namespace fresco
