#include "tools/installation.h"

#include <fmt/format.h>

#include "core/error.h"

namespace fresco {
namespace {

std::filesystem::path OwnDirectory() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

}  // namespace

std::filesystem::path SiblingProgram(const std::string& name) {
  const std::filesystem::path path = OwnDirectory() / name;
  if (!std::filesystem::exists(path)) {
    throw UsageError("expected the program " + path.string() +
                     " beside this one; build or install all of Fresco");
  }
  return path;
}

std::string SharedFile(const std::string& name) {
  const std::filesystem::path path = OwnDirectory().parent_path() / "share/fresco" / name;
  if (!std::filesystem::exists(path)) {
    throw UsageError("expected " + path.string() +
                     ", found none; tools/fresco spy installs a Java development kit and builds it");
  }
  return path.string();
}

std::string ConfigPath(const std::string& name) {
  const std::filesystem::path relative = std::filesystem::path("configs") / name;
  // build/<preset>/bin in the source tree; <prefix>/bin when installed.
  const std::filesystem::path own = OwnDirectory();
  for (const auto& path : {relative, own / "../../.." / relative, own / "../share/fresco" / relative}) {
    if (std::filesystem::exists(path)) {
      return path.lexically_normal().string();
    }
  }
  throw UsageError(fmt::format("--config: {} was not found; name an experiment", relative.string()));
}

}  // namespace fresco
