#include "learner/checkpoint_folder.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <system_error>

#include "core/atomic_file.h"
#include "core/error.h"

namespace fresco {
namespace {

constexpr char kExtension[] = ".checkpoint";

}  // namespace

std::filesystem::path CheckpointFolder::PathFor(int64_t committed_orders) const {
  return directory_ / fmt::format("{:012}{}", committed_orders, kExtension);
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
  std::error_code error;  // no folder: no checkpoint
  for (const auto& entry : std::filesystem::directory_iterator(directory_, error)) {
    if (entry.path().extension() == kExtension) {
      paths.push_back(entry.path());
    }
  }
  std::sort(paths.begin(), paths.end(), std::greater<>());
  return paths;
}

void CheckpointFolder::Prune(int kept) const {
  const std::vector<std::filesystem::path> paths = Latest();
  for (size_t i = static_cast<size_t>(kept); i < paths.size(); ++i) {
    std::error_code error;  // one too many does no harm
    std::filesystem::remove(paths[i], error);
  }
}

std::optional<Checkpoint> CheckpointFolder::ReadLatest() const {
  const std::vector<std::filesystem::path> paths = Latest();
  std::string problems;
  for (const std::filesystem::path& path : paths) {
    try {
      Checkpoint checkpoint = ParseCheckpoint(ReadFile(path), path.string());
      if (!problems.empty()) {
        spdlog::warn("going on from {} instead", path.string());
      }
      return checkpoint;
    } catch (const Error& error) {
      spdlog::warn("{}", error.what());
      problems += fmt::format("\n  {}", error.what());
    }
  }
  if (paths.empty()) {
    return std::nullopt;
  }
  throw UsageError(fmt::format("{}: none of its {} checkpoints can be used; begin a new run:{}",
                               directory_.string(), paths.size(), problems));
}

}  // namespace fresco
