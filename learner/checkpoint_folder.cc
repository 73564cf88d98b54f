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
constexpr char kUnusable[] = ".unusable";
constexpr int kDigits = 12;

bool IsCheckpointName(const std::filesystem::path& path) {
  const std::string stem = path.stem();
  return path.extension() == kExtension && stem.size() == kDigits &&
         std::all_of(stem.begin(), stem.end(), [](char c) { return c >= '0' && c <= '9'; });
}

void SetAside(const std::filesystem::path& path) {
  const std::filesystem::path aside = path.string() + kUnusable;
  std::error_code error;
  std::filesystem::rename(path, aside, error);
  if (error) {
    throw Failure(
        fmt::format("can't rename {} to {}: {}; it has to make room for the checkpoints to come, remove it",
                    path.string(), aside.filename().string(), error.message()));
  }
  spdlog::warn("renamed {} to {}", path.string(), aside.filename().string());
}

}  // namespace

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
  std::error_code error;  // no folder: no checkpoint
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
    std::error_code error;  // one too many does no harm
    std::filesystem::remove(paths[i], error);
  }
}

std::optional<Checkpoint> CheckpointFolder::TakeLatest(const Check& check) const {
  const std::vector<std::filesystem::path> paths = Latest();
  std::vector<std::string> problems;  // one for each that is later than the one taken
  std::optional<Checkpoint> taken;
  for (size_t i = 0; i < paths.size() && !taken; ++i) {
    try {
      Checkpoint checkpoint = ParseCheckpoint(ReadFile(paths[i]), paths[i].string());
      check(checkpoint, paths[i]);
      taken = std::move(checkpoint);
    } catch (const Error& error) {
      problems.emplace_back(error.what());
    }
  }
  if (!taken && !paths.empty()) {
    throw UsageError(fmt::format("{}: none of its {} checkpoints can be used:\n  {}", directory_.string(),
                                 paths.size(), fmt::join(problems, "\n  ")));
  }
  for (size_t later = 0; later < problems.size(); ++later) {
    spdlog::warn("{}; going on from {} instead", problems[later], paths[problems.size()].filename().string());
    SetAside(paths[later]);
  }
  return taken;
}

}  // namespace fresco
