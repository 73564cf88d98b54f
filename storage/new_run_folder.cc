#include "storage/new_run_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <ctime>

namespace fresco {

std::filesystem::path NewRunFolder() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char name[32];
  std::strftime(name, sizeof name, "%Y%m%dT%H%M%SZ", &utc);
  return std::filesystem::path("runs") / fmt::format("{}-{}", name, getpid());
}

}  // namespace fresco
