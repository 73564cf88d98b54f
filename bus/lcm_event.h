// One message as it stood on the bus, and as LCM's event logs keep it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace fresco {

/// What an event log has before an event's channel: sync word, number, time, two lengths, big-endian.
inline constexpr size_t kEventHeaderBytes = 28;

/// Channel and message point into whoever handed the event out, and are valid as long as that says.
struct LcmEvent {
  int64_t number = 0;  ///< place in its log: 0, 1, ..; on a bus, place among what was received
  int64_t utime = 0;   ///< microseconds since the epoch, when it was received
  std::string_view channel = {};
  std::span<const std::byte> message = {};
};

}  // namespace fresco
