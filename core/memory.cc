#include "core/memory.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <sstream>

#include "core/error.h"

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

void LowerTo(int64_t bytes, const std::string& source, MemoryLimit& limit) {
  if (bytes < limit.bytes) {
    limit = {std::max<int64_t>(0, bytes), source};
  }
}

void ApplyControlGroup(const Path& folder, const ControlGroupFiles& files, MemoryLimit& host) {
  const std::optional<int64_t> limit = NumberIn(folder / files.limit);
  const std::optional<int64_t> usage = NumberIn(folder / files.usage);
  if (!limit || !usage) {
    return;
  }
  const Path statistics = folder / "memory.stat";
  const int64_t droppable = NumberIn(statistics, files.inactive_file).value_or(0) +
                            NumberIn(statistics, files.active_file).value_or(0);
  LowerTo(*limit - std::max<int64_t>(0, *usage - droppable),
          "the control group's limit in " + (folder / files.limit).string(), host);
}

/// The group at `path` and all above it. In a container only the uppermost folder may be visible.
void ApplyControlGroups(const Path& root, const std::string& path, const ControlGroupFiles& files,
                        MemoryLimit& host) {
  for (Path group = Path(path).relative_path();; group = group.parent_path()) {
    ApplyControlGroup(root / files.folder / group, files, host);
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
void ApplyControlGroups(const Path& root, MemoryLimit& host) {
  std::ifstream stream(root / "proc/self/cgroup");
  for (std::string line; std::getline(stream, line);) {
    const size_t first = line.find(':');
    const size_t second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) {
      continue;
    }
    const std::string controllers = line.substr(first + 1, second - first - 1);
    if (controllers.empty()) {
      ApplyControlGroups(root, line.substr(second + 1), kVersion2, host);
    } else if (NamesMemory(controllers)) {
      ApplyControlGroups(root, line.substr(second + 1), kVersion1, host);
    }
  }
}

void ApplyResourceLimit(__rlimit_resource resource, const std::string& name, int64_t taken_bytes,
                        MemoryLimit& process) {
  rlimit limit{};
  if (getrlimit(resource, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    LowerTo(static_cast<int64_t>(limit.rlim_cur) - taken_bytes, name, process);
  }
}

/// The largest parts first, those that are too small to matter left out.
std::vector<MemoryPart> LargeParts(const MemoryNeed& need) {
  constexpr int64_t kSmallShare = 50;
  std::vector<MemoryPart> parts;
  for (const MemoryPart& part : need.parts) {
    if (part.bytes >= need.bytes() / kSmallShare && !part.field.empty()) {
      parts.push_back(part);
    }
  }
  std::stable_sort(parts.begin(), parts.end(),
                   [](const MemoryPart& a, const MemoryPart& b) { return a.bytes > b.bytes; });
  return parts;
}

std::string NeedText(const MemoryNeed& need) {
  std::vector<std::string> parts;
  for (const MemoryPart& part : LargeParts(need)) {
    parts.push_back(fmt::format("{} for {} ({})", BytesText(part.bytes), part.purpose, part.field));
  }
  return fmt::format("{} {}: {}",
                     need.processes == 1 ? "the " + need.process
                                         : fmt::format("each of {} {}s", need.processes, need.process),
                     BytesText(need.bytes()), fmt::join(parts, ", "));
}

[[noreturn]] void Refuse(const std::vector<MemoryNeed>& needs, int64_t bytes, const MemoryLimit& limit) {
  MemoryPart largest;
  std::vector<std::string> texts;
  for (const MemoryNeed& need : needs) {
    for (const MemoryPart& part : need.parts) {
      if (!part.field.empty() && part.bytes * need.processes > largest.bytes) {
        largest = {part.field, part.purpose, part.bytes * need.processes};
      }
    }
    texts.push_back(NeedText(need));
  }
  throw UsageError(fmt::format(
      "{0}: {1} needs {2}; in all {3} of memory are needed and {4} are available ({5}). In detail: {6}. "
      "Lower {0}, or run it where there is more memory",
      largest.field, largest.purpose, BytesText(largest.bytes), BytesText(bytes), BytesText(limit.bytes),
      limit.source, fmt::join(texts, "; ")));
}

}  // namespace

AvailableMemory ReadAvailableMemory(const Path& root) {
  constexpr int64_t kBytesPerKib = 1024;
  AvailableMemory available;
  if (const auto kib = NumberIn(root / "proc/meminfo", "MemAvailable:")) {
    LowerTo(*kib * kBytesPerKib, "MemAvailable in /proc/meminfo", available.host);
  }
  ApplyControlGroups(root, available.host);
  available.process = available.host;
  const Path status = root / "proc/self/status";
  ApplyResourceLimit(RLIMIT_AS, "ulimit -v", NumberIn(status, "VmSize:").value_or(0) * kBytesPerKib,
                     available.process);
  ApplyResourceLimit(RLIMIT_DATA, "ulimit -d", NumberIn(status, "VmData:").value_or(0) * kBytesPerKib,
                     available.process);
  return available;
}

int64_t MemoryNeed::bytes() const {
  int64_t sum = 0;
  for (const MemoryPart& part : parts) {
    sum += part.bytes;
  }
  return sum;
}

int64_t HeapBytes(int64_t bytes) {
  constexpr int64_t kHeader = 8;
  constexpr int64_t kLeast = 32;
  constexpr int64_t kAlignment = 16;
  return std::max(kLeast, (bytes + kHeader + kAlignment - 1) / kAlignment * kAlignment);
}

std::string BytesText(int64_t bytes) {
  constexpr double kMega = 1e6;
  constexpr double kGiga = 1e9;
  const auto value = static_cast<double>(bytes);
  return value >= kGiga ? fmt::format("{:.1f} GB", value / kGiga) : fmt::format("{:.1f} MB", value / kMega);
}

void RefuseIfTooLarge(const std::vector<MemoryNeed>& needs, const AvailableMemory& available) {
  int64_t together = 0;
  for (const MemoryNeed& need : needs) {
    if (need.processes > 0 && need.bytes() > available.process.bytes) {
      Refuse({need}, need.bytes(), available.process);
    }
    together += need.bytes() * need.processes;
  }
  if (together > available.host.bytes) {
    Refuse(needs, together, available.host);
  }
}

}  // namespace fresco
