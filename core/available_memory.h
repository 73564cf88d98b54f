// How much memory this process and those that it starts can still take on this host. Linux only. Thread-safe.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>

namespace fresco {

/// Bytes that can still be taken, and what says so.
struct MemoryLimit {
  int64_t bytes = std::numeric_limits<int64_t>::max();
  std::string source = "no limit";
};

struct AvailableMemory {
  MemoryLimit host;     ///< for all processes together: what the kernel has, and the control group's rest
  MemoryLimit process;  ///< for one process alone: what `ulimit` leaves, at most `host`
};

/// As it is now: the least of MemAvailable in /proc/meminfo, the rest of the control group of this process
/// and of those above it (cgroup v2 and v1; file pages that the kernel can drop count as free), and, for one
/// process, RLIMIT_AS and RLIMIT_DATA. What can't be read is no limit. `root` is the root of the file system.
AvailableMemory ReadAvailableMemory(const std::filesystem::path& root = "/");

}  // namespace fresco
