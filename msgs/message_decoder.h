// Decodes messages of any of Fresco's types, or reads only those of their fields that have a fixed offset
// (fast enough for logs of gigabytes). For programs that look at a complete log or at all channels. LCM
// begins every message with a fingerprint of its type, which says how to decode it. (The programs of a run
// know the type of each channel and use msgs/wire.h.) The functions may be called from any
// thread. One thread at a time may use an object, which reuses its messages, so it stops allocating after a
// while.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>

#include "core/bytes.h"
#include "msgs/wire.h"

namespace fresco {

/// Returns the message without its authentication tag if it carries one (see CarriesAuthentication),
/// otherwise all of the bytes. Does not check the tag.
std::span<const std::byte> WithoutAuthentication(std::span<const std::byte> bytes);

/// Whether the bytes begin with the fingerprint of this type. LCM computes fingerprints from the names and
/// types of all fields.
template <class Message>
bool BeginsAs(std::span<const std::byte> bytes) {
  return bytes.size() >= sizeof(uint64_t) &&
         ReadBigEndian<uint64_t>(bytes.data()) == static_cast<uint64_t>(Message::getHash());
}

class MessageDecoder {
 public:
  enum class Result {
    kDecoded,  ///< the handler was called
    kDamaged,  ///< the fingerprint is that of a Fresco message, but the rest does not decode
    kForeign,  ///< not a Fresco message
  };

  /// Decodes the bytes and calls `handler(const Message&)` with the message. An authentication tag behind the
  /// message is ignored. The message is valid until the next call.
  template <class Handler>
  Result Decode(std::span<const std::byte> bytes, Handler&& handler) {
    Result result = Result::kForeign;
    const auto attempt = [&](auto& message) {
      if (!BeginsAs<std::remove_reference_t<decltype(message)>>(bytes)) {
        return false;
      }
      const bool decodes =
          fresco::Decode(bytes, message) || fresco::Decode(WithoutAuthentication(bytes), message);
      result = decodes ? Result::kDecoded : Result::kDamaged;
      if (result == Result::kDecoded) {
        handler(std::as_const(message));
      }
      return true;
    };
    std::apply([&](auto&... messages) { (attempt(messages) || ...); }, messages_);
    return result;
  }

 private:
  MessageTypes messages_;
};

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
  int32_t first_field = 0;
  bool ends_episode = false;  ///< the episode ends with the last of these transitions
};

/// Reads the header if the bytes are a valid transitions_t (its CRC is checked), with or without an
/// authentication tag; otherwise returns nullopt.
std::optional<TransitionsHeader> PeekTransitions(std::span<const std::byte> bytes);

}  // namespace fresco
