// From LCM's generated types to bytes and back, guarded: generated decoders trust counts, so every count
// is checked before they run. This is possible because all counts follow the identity of a message (utime,
// run_id, config_hash) directly. Any thread may call the functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <span>
#include <type_traits>
#include <vector>

#include "fresco/message_descriptions.hpp"

namespace fresco {

/// Raised with every change to a .lcm file, and of what an order means.
inline constexpr int32_t kProtocolVersion = 9;

/// Every message fits one Ethernet frame: LCM drops a message if one of its fragments is lost.
inline constexpr size_t kMaximumMessageBytes = 1350;
/// Kept free in every message for a trailer behind LCM's encoding, which LCM's own decoders ignore: the
/// CRC-32C of the encoding, big-endian (UDP's checksum lets too much through for a promise about bits), and
/// on an authenticated bus the tag (bus/authenticated_bus.h), which is added behind these codecs.
inline constexpr size_t kReservedTrailerBytes = 48;
inline constexpr size_t kTrailerBytes = sizeof(uint32_t);
inline constexpr size_t kMaximumEncodedBytes = kMaximumMessageBytes - kReservedTrailerBytes;

// The limits of the .lcm files, as numbers.
inline constexpr int kMaximumOrdersPerMessage = orders_t::MAXIMUM_ORDER_COUNT;
inline constexpr int kMaximumTransitionsPerMessage = transitions_t::MAXIMUM_TRANSITION_COUNT;
inline constexpr int kMaximumPartBytes = run_t::MAXIMUM_PART_SIZE;
inline constexpr int kMaximumParts = run_t::MAXIMUM_PART_COUNT;
inline constexpr int kMaximumHeldVersions = actor_status_t::MAXIMUM_HELD_COUNT;
inline constexpr int kMaximumMissingRanges = actor_status_t::MAXIMUM_MISSING_COUNT;
inline constexpr int kMaximumSensorsPerScenario = scenario_t::MAXIMUM_SENSOR_COUNT;
inline constexpr int kMaximumCellsPerScenario = scenario_t::MAXIMUM_CELL_COUNT;
inline constexpr size_t kMaximumHostBytes = actor_status_t::MAXIMUM_HOST_BYTES;
inline constexpr size_t kMaximumWaitingForBytes = learner_status_t::MAXIMUM_WAITING_FOR_BYTES;
inline constexpr size_t kMaximumWarningBytes = learner_status_t::MAXIMUM_WARNING_BYTES;
inline constexpr size_t kMaximumEntriesBytes = world_t::MAXIMUM_ENTRIES_BYTES;
inline constexpr size_t kMaximumPolicyBytes = flight_t::MAXIMUM_POLICY_BYTES;
inline constexpr int kValuesPerChunk = weights_t::MAXIMUM_VALUE_COUNT;

/// Which run a message belongs to: its run_id and the hash of the run's configuration.
struct RunIdentity {
  int64_t run_id = 0;
  uint32_t config_hash = 0;
  bool operator==(const RunIdentity&) const = default;
};

/// LCM's encoding without the trailer; empty if the size is not allowed or the CRC is wrong.
std::span<const std::byte> WithoutTrailer(std::span<const std::byte> bytes);

/// Whether bytes that do not decode are a sound message with an authentication tag behind it: their sender
/// has a key, and this receiver has none.
bool CarriesAuthentication(std::span<const std::byte> bytes);

/// CHECKs that LCM encoded `encoded` bytes of the expected size, and appends the trailer.
void AppendTrailer(int encoded, std::vector<std::byte>& bytes);

/// Whether the counts in the encoding lie in 0 .. maxima.
bool CountsAreAllowed(std::span<const std::byte> encoding, std::span<const int32_t> maxima);

/// Whether `count` texts, one behind the other from `offset` on, lie within the encoding and are as an
/// encoder writes them: a length of four bytes and one NUL, at the end. LCM's decoders subtract one from any
/// length and take any byte for the NUL; its encoders stop at the first.
bool TextsAreAllowed(std::span<const std::byte> encoding, size_t offset, int count);

/// Decodes a message; false if it is corrupt, of another type, malformed, oversized or longer
/// than its content. What decodes encodes to the same bytes again. Never throws, never allocates more than
/// the limits allow.
template <class Message>
bool Decode(std::span<const std::byte> bytes, Message& message) {
  const std::span<const std::byte> encoding = WithoutTrailer(bytes);
  using Fields = Description<Message>;
  if (!CountsAreAllowed(encoding, Fields::kCountMaxima) ||
      !TextsAreAllowed(encoding, Fields::kFixedBytes, Fields::kTexts)) {
    return false;
  }
  try {
    const int size = static_cast<int>(encoding.size());
    return message.decode(encoding.data(), 0, size) == size;
  } catch (const std::exception&) {
    return false;
  }
}

/// Replaces `bytes` by the encoded message and its trailer. CHECKs that the encoding fits
/// kMaximumEncodedBytes.
template <class Message>
void Encode(const Message& message, std::vector<std::byte>& bytes) {
  bytes.resize(static_cast<size_t>(message.getEncodedSize()));
  AppendTrailer(message.encode(bytes.data(), 0, static_cast<int>(bytes.size())), bytes);
}

/// Calls visit(const char* name, const auto& value) for every field of a message, or of an order_t or
/// chunk_range_t in one, in the order of its .lcm file. Values are numbers, texts, vectors of these or of
/// order_t and chunk_range_t, and vectors of vectors.
template <class Message, class Visitor>
void ForEachField(const Message& message, Visitor&& visit) {
  Description<Message>::ForEachField(message, visit);
}

/// Sets utime to now, and the identity.
template <class Message>
void Stamp(Message& message, RunIdentity identity, int64_t utime) {
  message.utime = utime;
  message.run_id = identity.run_id;
  message.config_hash = identity.config_hash;
}

template <class Message>
RunIdentity IdentityOf(const Message& message) {
  return {message.run_id, static_cast<uint32_t>(message.config_hash)};
}

}  // namespace fresco
