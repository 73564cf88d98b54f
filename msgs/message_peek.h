// A look at what stands at fixed places of a message, without decoding the rest: for those who go through
// logs of gigabytes. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "msgs/message_decoder.h"

namespace fresco {

/// Which of Fresco's messages the bytes begin as, by its name ("run_t"); nullptr: none.
const char* PeekType(std::span<const std::byte> bytes);

/// The run of a message that begins as one of Fresco's; nullopt for all others. The message may be damaged.
std::optional<RunIdentity> PeekIdentity(std::span<const std::byte> bytes);

/// What a transitions_t is about.
struct TransitionsHeader {
  RunIdentity identity;
  int32_t transition_count = 0;
  int64_t order_index = 0;
  int64_t actor_id = 0;
  int32_t first_transition = 0;
  bool ends_episode = false;
};

/// For bytes that decode as transitions_t (their CRC is looked at), with or without an authentication tag;
/// nullopt for all others.
std::optional<TransitionsHeader> PeekTransitions(std::span<const std::byte> bytes);

}  // namespace fresco
