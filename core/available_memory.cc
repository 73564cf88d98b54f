#include "core/available_memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <sstream>
#include <utility>

namespace fresco {
namespace {

using Path = std::filesystem::path;

/// The number behind `name` in a file of lines "name number ..."; an empty name: the file's first number.
/// None if the file can't be read or says "max".
std::optional<int64_t> NumberIn(const Path& file, const std::string& name = "") {
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line);
    std::string first;
    int64_t number = 0;
    if (!name.empty() && (!(words >> first) || first != name)) {
      continue;
    }
    return words >> number ? std::optional(number) : std::nullopt;
  }
  return std::nullopt;
}

/// Where a version of control groups keeps its files, and what they are called.
struct ControlGroupFiles {
  const char* folder;
  const char* limit;
  const char* usage;
  const char* inactive_file;  // in memory.stat
  const char* active_file;
};
constexpr ControlGroupFiles kVersion2 = {"sys/fs/cgroup", "memory.max", "memory.current", "inactive_file",
                                         "active_file"};
constexpr ControlGroupFiles kVersion1 = {"sys/fs/cgroup/memory", "memory.limit_in_bytes",
                                         "memory.usage_in_bytes", "total_inactive_file", "total_active_file"};

void TakeLesser(int64_t bytes, const std::string& source, MemoryLimit& limit) {
  if (bytes < limit.bytes) {
    limit = {std::max<int64_t>(0, bytes), source};
  }
}

void TakeControlGroup(const Path& folder, const ControlGroupFiles& files, MemoryLimit& host) {
  const std::optional<int64_t> limit = NumberIn(folder / files.limit);
  const std::optional<int64_t> usage = NumberIn(folder / files.usage);
  if (!limit || !usage) {
    return;
  }
  const Path statistics = folder / "memory.stat";
  const int64_t droppable = NumberIn(statistics, files.inactive_file).value_or(0) +
                            NumberIn(statistics, files.active_file).value_or(0);
  TakeLesser(*limit - std::max<int64_t>(0, *usage - droppable),
             "the control group's limit in " + (folder / files.limit).string(), host);
}

/// The group at `path` and all above it. In a container only the uppermost folder may be visible.
void TakeControlGroups(const Path& root, const std::string& path, const ControlGroupFiles& files,
                       MemoryLimit& host) {
  for (Path group = Path(path).relative_path();; group = group.parent_path()) {
    TakeControlGroup(root / files.folder / group, files, host);
    if (group.empty()) {
      return;
    }
  }
}

/// Of a list "cpu,memory".
bool NamesMemory(const std::string& controllers) {
  std::istringstream names(controllers);
  for (std::string name; std::getline(names, name, ',');) {
    if (name == "memory") {
      return true;
    }
  }
  return false;
}

/// Lines of /proc/self/cgroup: "0::/path" for version 2, "number:controllers:/path" for version 1.
void TakeControlGroups(const Path& root, MemoryLimit& host) {
  std::ifstream stream(root / "proc/self/cgroup");
  for (std::string line; std::getline(stream, line);) {
    const size_t first = line.find(':');
    const size_t second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) {
      continue;
    }
    const std::string controllers = line.substr(first + 1, second - first - 1);
    if (controllers.empty()) {
      TakeControlGroups(root, line.substr(second + 1), kVersion2, host);
    } else if (NamesMemory(controllers)) {
      TakeControlGroups(root, line.substr(second + 1), kVersion1, host);
    }
  }
}

void TakeResourceLimit(__rlimit_resource resource, const std::string& name, int64_t taken_bytes,
                       MemoryLimit& process) {
  rlimit limit{};
  if (getrlimit(resource, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    TakeLesser(static_cast<int64_t>(limit.rlim_cur) - taken_bytes, name, process);
  }
}

}  // namespace

AvailableMemory ReadAvailableMemory(const Path& root) {
  constexpr int64_t kBytesPerKib = 1024;
  AvailableMemory available;
  if (const auto kib = NumberIn(root / "proc/meminfo", "MemAvailable:")) {
    TakeLesser(*kib * kBytesPerKib, "MemAvailable in /proc/meminfo", available.host);
  }
  TakeControlGroups(root, available.host);
  available.process = available.host;
  const Path status = root / "proc/self/status";
  TakeResourceLimit(RLIMIT_AS, "ulimit -v", NumberIn(status, "VmSize:").value_or(0) * kBytesPerKib,
                    available.process);
  TakeResourceLimit(RLIMIT_DATA, "ulimit -d", NumberIn(status, "VmData:").value_or(0) * kBytesPerKib,
                    available.process);
  return available;
}

}  // namespace fresco
