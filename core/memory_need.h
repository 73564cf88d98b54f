// What a configuration makes a process take of memory, part by part, and the refusal of what can't be. The
// numbers come from functions beside the classes that take the memory (BytesFor). Pure.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/available_memory.h"

namespace fresco {

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
