#include "msgs/ready_experiments.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/error.h"
#include "core/installation.h"

namespace fresco {
namespace {

constexpr char kExtension[] = ".textproto";

std::filesystem::path ReadyFolder() {
  return SharedFolder() / "configs";
}

/// Returns NAME for NAME, NAME.textproto and configs/NAME.textproto.
std::string ReadyName(const std::string& config) {
  std::filesystem::path path(config);
  if (path.parent_path() == "configs") {
    path = path.filename();
  }
  return path.extension() == kExtension ? path.replace_extension().string() : path.string();
}

}  // namespace

std::vector<std::string> ReadyExperiments() {
  std::vector<std::string> names;
  std::error_code error;  // ignored: without a folder there are no experiments
  for (const auto& entry : std::filesystem::directory_iterator(ReadyFolder(), error)) {
    if (entry.path().extension() == kExtension) {
      names.push_back(entry.path().stem().string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string ExperimentPath(const std::string& config) {
  std::error_code error;
  const std::filesystem::file_status found = std::filesystem::status(config, error);
  if (std::filesystem::exists(found) && !std::filesystem::is_directory(found)) {
    return config;
  }
  const std::vector<std::string> ready = ReadyExperiments();
  const std::string name = ReadyName(config);
  if (std::find(ready.begin(), ready.end(), name) != ready.end()) {
    return (ReadyFolder() / (name + kExtension)).string();
  }
  if (std::filesystem::exists(found)) {
    return config;  // a folder: whoever reads it says so
  }
  throw UsageError(fmt::format(
      "--config: expected a file or the name of a ready experiment ({} in {}); \"{}\" is neither{}",
      ready.empty() ? "none" : fmt::format("{}", fmt::join(ready, ", ")), ReadyFolder().string(), config,
      DidYouMean(name, ready)));
}

std::string ConfigHelp(const std::string& without_it) {
  return fmt::format("Experiment: a file, or the name of a ready one ({}); default: {}",
                     fmt::join(ReadyExperiments(), ", "), without_it);
}

}  // namespace fresco
