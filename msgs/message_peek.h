// Reads the fields of a message that have a fixed offset, without decoding the rest: fast enough for logs of
// gigabytes. Pure functions; any thread may call them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "msgs/message_decoder.h"

namespace fresco {

/// The name of the Fresco type whose fingerprint the bytes begin with ("run_t"), or nullptr if there is none.
const char* PeekType(std::span<const std::byte> bytes);

/// The run that a message belongs to; nullopt if the bytes do not begin with the fingerprint of a Fresco
/// type. Checks nothing else, so the message may still be damaged.
std::optional<RunIdentity> PeekIdentity(std::span<const std::byte> bytes);

/// The fixed fields of a transitions_t; see msgs/lcm/transitions_t.lcm.
struct TransitionsHeader {
  RunIdentity identity;
  int32_t transition_count = 0;
  int64_t order_index = 0;
  int64_t actor_id = 0;
  int32_t first_transition = 0;
  bool ends_episode = false;  ///< the last of these transitions is terminal
};

/// Reads the header if the bytes are a valid transitions_t (its CRC is checked), with or without an
/// authentication tag; otherwise returns nullopt.
std::optional<TransitionsHeader> PeekTransitions(std::span<const std::byte> bytes);

}  // namespace fresco
