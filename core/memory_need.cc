#include "core/memory_need.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"

namespace fresco {
namespace {

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
