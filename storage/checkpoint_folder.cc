#include "storage/checkpoint_folder.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <system_error>

#include "core/atomic_file.h"
#include "core/error.h"

namespace fresco {
namespace {

constexpr char kExtension[] = ".checkpoint";
constexpr char kUnusable[] = ".unusable";
constexpr int kDigits = 12;

bool IsCheckpointName(const std::filesystem::path& path) {
  const std::string stem = path.stem();
  return path.extension() == kExtension && stem.size() == kDigits &&
         std::all_of(stem.begin(), stem.end(), [](char c) { return c >= '0' && c <= '9'; });
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

CheckpointFolder::Found CheckpointFolder::FindLatest(const Check& check) const {
  Found found;
  for (const std::filesystem::path& path : Latest()) {
    try {
      Checkpoint checkpoint = ParseCheckpoint(ReadFile(path), path.string());
      check(checkpoint, path);
      found.checkpoint = std::move(checkpoint);
      return found;
    } catch (const Error& error) {
      found.unusable.push_back({path, error.what()});
    }
  }
  if (!found.unusable.empty()) {
    std::string problems;
    for (const UnusableCheckpoint& checkpoint : found.unusable) {
      problems += "\n  " + checkpoint.problem;
    }
    throw UsageError(fmt::format("{}: none of its {} checkpoints can be used:{}", directory_.string(),
                                 found.unusable.size(), problems));
  }
  return found;
}

}  // namespace fresco
