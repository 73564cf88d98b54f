// How much memory a configuration makes the processes of a run take, part by part, how much the host has, and
// the refusal of what can't be. The numbers of a need come from functions beside the classes that take the
// memory (BytesFor). Linux only. Any thread may call these functions.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

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

struct MemoryPart {
  std::string field;    ///< of the configuration, to be lowered; empty: none
  std::string purpose;  ///< "the replay memory"
  int64_t bytes = 0;
};

/// Of processes of one kind, all of the same size.
struct MemoryNeed {
  std::string process;  ///< "learner"
  int64_t processes = 1;
  std::vector<MemoryPart> parts;  ///< of one of the processes

  /// Of one of the processes.
  int64_t bytes() const;
};

/// What a process takes for itself whatever the configuration says: stacks, buffers of LCM and of libraries.
/// (An actor of configs/ci.textproto has 1.6 MB of private memory in all.)
inline constexpr int64_t kProgramBytes = 2'000'000;

/// What glibc's malloc takes for one block of so many bytes.
int64_t HeapBytes(int64_t bytes);

/// "12.3 GB", "45 MB": decimal units.
std::string BytesText(int64_t bytes);

/// Throws UsageError if one of the processes, or all together, need more than there is: which field is the
/// large part, the bytes needed, the bytes available and what says so, the other large parts, and what to
/// lower.
void RefuseIfTooLarge(const std::vector<MemoryNeed>& needs, const AvailableMemory& available);

}  // namespace fresco
