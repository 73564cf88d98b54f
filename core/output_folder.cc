#include "core/output_folder.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/error.h"

namespace fresco {

void CheckOutputFolder(const std::filesystem::path& folder, const std::string& option) {
  std::error_code error;  // a path that can't be looked at counts as not there; its parent tells why
  std::filesystem::path there = std::filesystem::absolute(folder);
  while (!std::filesystem::exists(there, error) && there.has_relative_path()) {
    there = there.parent_path();
  }
  if (!std::filesystem::is_directory(there, error)) {
    throw UsageError(option + ": can't make the folder " + folder.string() + ": " + there.string() +
                     " is not a folder");
  }
  if (::faccessat(AT_FDCWD, there.c_str(), W_OK | X_OK, AT_EACCESS) != 0) {
    throw UsageError(option + ": can't write to the folder " + folder.string() + ": " + there.string() +
                     ": " + std::strerror(errno));
  }
}

}  // namespace fresco
