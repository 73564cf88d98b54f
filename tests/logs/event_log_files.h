// Event logs for tests: written and read by LCM's own library, or byte by byte as its format is published.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bus/bus.h"

namespace fresco {

/// An event that owns its content.
struct LogEvent {
  int64_t utime = 0;
  std::string channel = {};
  std::string message = {};
  bool operator==(const LogEvent&) const = default;
};

LogEvent Owned(const LcmEvent& event);
LcmEvent EventOf(const LogEvent& event);

/// Events of many sizes and channels, a millisecond apart; some contain the sync word, one is empty.
std::vector<LogEvent> SampleEvents(int count, int64_t first_utime = 1'700'000'000'000'000);

/// Returns the lowest `size` bytes of the number, most significant first, as LCM writes numbers.
std::string BigEndian(uint64_t value, int size);

/// Returns the bytes of a log, made after the published format.
std::string LogBytes(const std::vector<LogEvent>& events);

void WriteWithLcm(const std::filesystem::path& path, const std::vector<LogEvent>& events);
/// Expects the events' numbers to be 0, 1, 2, ..
std::vector<LogEvent> ReadWithLcm(const std::filesystem::path& path);

void WriteBytes(const std::filesystem::path& path, const std::string& bytes);

}  // namespace fresco
