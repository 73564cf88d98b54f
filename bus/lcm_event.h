// One message as it was on the bus, or as an event log of LCM stores it. A plain value.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace fresco {

/// The bytes before the channel of each event in an event log: sync word, number, time and two lengths,
/// big-endian.
inline constexpr size_t kEventHeaderBytes = 28;

/// `channel` and `message` point into memory of the object that handed the event out, which says how long
/// they are valid.
struct LcmEvent {
  int64_t number = 0;  ///< 0, 1, .. in the order of the log, or in the order of arrival on a bus
  int64_t utime = 0;   ///< time of arrival, microseconds since the epoch
  std::string_view channel = {};
  std::span<const std::byte> message = {};
};

}  // namespace fresco
