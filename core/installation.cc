#include "core/installation.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <sstream>

#include "core/error.h"

namespace fresco {
namespace {

std::filesystem::path OwnFolder() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

bool CanBeRun(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error) && ::access(path.c_str(), X_OK) == 0;
}

}  // namespace

const char* const kSoftwareVersion = FRESCO_VERSION;  // from core/CMakeLists.txt

std::string ProgramName() {
  return program_invocation_name;
}

std::filesystem::path SiblingProgram(const std::string& name) {
  const std::filesystem::path path = OwnFolder() / name;
  if (!CanBeRun(path)) {
    throw UsageError("expected the program " + path.string() +
                     " beside this one; build or install all of Fresco");
  }
  return path;
}

std::filesystem::path SharedFolder() {
  return std::filesystem::weakly_canonical(OwnFolder() / FRESCO_SHARED_FOLDER);  // from core/CMakeLists.txt
}

std::filesystem::path LibraryFolder() {
  return std::filesystem::weakly_canonical(OwnFolder() / FRESCO_LIBRARY_FOLDER);  // from core/CMakeLists.txt
}

void RequireProgram(const std::string& name, const std::string& package) {
  const char* search_path = std::getenv("PATH");
  std::istringstream folders(search_path == nullptr ? "" : search_path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (CanBeRun(std::filesystem::path(folder) / name)) {
      return;
    }
  }
  throw UsageError("expected the program " + name + " in PATH, found none; install it: apt-get install " +
                   package);
}

}  // namespace fresco
