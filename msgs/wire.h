// From LCM's generated types to bytes and back, guarded: generated decoders trust counts, so every
// count is looked at before they run. All counts of a message stand first after its identity
// (utime, run_id, config_hash), which is what makes the look possible. Thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <initializer_list>
#include <span>
#include <type_traits>
#include <vector>

#include "fresco/actor_status_t.hpp"
#include "fresco/flight_t.hpp"
#include "fresco/learner_status_t.hpp"
#include "fresco/orders_t.hpp"
#include "fresco/run_t.hpp"
#include "fresco/scenario_t.hpp"
#include "fresco/transitions_t.hpp"
#include "fresco/weights_t.hpp"

namespace fresco {

/// Raised with every change to a .lcm file.
inline constexpr int32_t kProtocolVersion = 4;

/// Every message fits one Ethernet frame: LCM loses a whole message with one lost fragment.
inline constexpr size_t kMaximumMessageBytes = 1350;
/// Kept free in every message for a trailer behind LCM's encoding, which LCM's own decoders ignore: the
/// CRC-32C of the encoding, big-endian (UDP's checksum lets too much through for a promise about bits), and
/// on an authenticated bus the tag (bus/authenticated_bus.h), which is added behind these codecs.
inline constexpr size_t kReservedTrailerBytes = 48;
inline constexpr size_t kTrailerBytes = sizeof(uint32_t);
inline constexpr size_t kMaximumEncodedBytes = kMaximumMessageBytes - kReservedTrailerBytes;

inline constexpr int kMaximumOrdersPerMessage = 27;
inline constexpr int kMaximumPartBytes = 1100;
inline constexpr int kMaximumParts = 1024;
inline constexpr int kMaximumHeldVersions = 32;
inline constexpr int kMaximumMissingRanges = 32;
inline constexpr int kMaximumSensors = 250;
inline constexpr int kMaximumSensorsPerScenario = 48;
inline constexpr size_t kMaximumHostBytes = 64;
/// Of what a learner status says to people, in each of its two texts, and of the name of a policy.
inline constexpr size_t kMaximumTextBytes = 240;
inline constexpr int kValuesPerChunk = 308;

/// Which run a message belongs to: its run_id and the hash of the run's configuration.
struct RunIdentity {
  int64_t run_id = 0;
  uint32_t config_hash = 0;
  bool operator==(const RunIdentity&) const = default;
};

/// The largest allowed value of each count of a message, in the order of its fields.
inline std::initializer_list<int32_t> CountMaxima(const run_t&) {
  static constexpr std::initializer_list<int32_t> kMaxima = {kMaximumPartBytes};
  return kMaxima;
}
inline std::initializer_list<int32_t> CountMaxima(const orders_t&) {
  static constexpr std::initializer_list<int32_t> kMaxima = {kMaximumOrdersPerMessage};
  return kMaxima;
}
inline std::initializer_list<int32_t> CountMaxima(const transitions_t&) {
  static constexpr std::initializer_list<int32_t> kMaxima = {128, 129, kMaximumSensors,
                                                             5 * (kMaximumSensors + 1) / 8 + 1};
  return kMaxima;
}
inline std::initializer_list<int32_t> CountMaxima(const weights_t&) {
  static constexpr std::initializer_list<int32_t> kMaxima = {kValuesPerChunk};
  return kMaxima;
}
inline std::initializer_list<int32_t> CountMaxima(const actor_status_t&) {
  static constexpr std::initializer_list<int32_t> kMaxima = {kMaximumHeldVersions, kMaximumMissingRanges};
  return kMaxima;
}
inline std::initializer_list<int32_t> CountMaxima(const learner_status_t&) {
  return {};
}
inline std::initializer_list<int32_t> CountMaxima(const scenario_t&) {
  static constexpr std::initializer_list<int32_t> kMaxima = {kMaximumSensorsPerScenario};
  return kMaxima;
}
inline std::initializer_list<int32_t> CountMaxima(const flight_t&) {
  static constexpr std::initializer_list<int32_t> kMaxima = {kMaximumSensors};
  return kMaxima;
}

/// LCM's encoding without the trailer; empty where the size is not allowed or the CRC does not hold.
std::span<const std::byte> WithoutTrailer(std::span<const std::byte> bytes);

/// Whether bytes that do not decode are a sound message with an authentication tag behind it: their sender
/// has a key, and this receiver has none.
bool CarriesAuthentication(std::span<const std::byte> bytes);

/// CHECKs that LCM encoded `encoded` bytes of the expected size, and appends the trailer.
void AppendTrailer(int encoded, std::vector<std::byte>& bytes);

/// Whether the counts in the encoding lie in 0 .. maxima.
bool CountsAreAllowed(std::span<const std::byte> encoding, std::initializer_list<int32_t> maxima);

/// Whether `count` texts, one behind the other from `offset` on, lie within the encoding and are as an
/// encoder writes them: a length of four bytes and one NUL, at the end. LCM's decoders subtract one from any
/// length and take any byte for the NUL; its encoders stop at the first.
bool TextsAreAllowed(std::span<const std::byte> encoding, size_t offset, int count);

/// How many texts a message has. They stand behind the fields of fixed size.
template <class Message>
inline constexpr int kTexts = 0;
template <>
inline constexpr int kTexts<actor_status_t> = 1;
template <>
inline constexpr int kTexts<learner_status_t> = 2;
template <>
inline constexpr int kTexts<flight_t> = 1;

template <class Message>
bool TextsAreAllowed(std::span<const std::byte> encoding, const Message&) {
  if constexpr (kTexts < Message >> 0) {
    constexpr size_t kEmptyTextBytes = sizeof(int32_t) + 1;
    const auto empty_bytes = static_cast<size_t>(Message{}.getEncodedSize());
    return TextsAreAllowed(encoding, empty_bytes - kTexts<Message> * kEmptyTextBytes, kTexts<Message>);
  }
  return true;
}

/// Decodes a message; false where it is corrupt, of another type, malformed, oversized or longer
/// than its content. What decodes encodes to the same bytes again. Never throws, never allocates more than
/// the limits allow.
template <class Message>
bool Decode(std::span<const std::byte> bytes, Message& message) {
  const std::span<const std::byte> encoding = WithoutTrailer(bytes);
  if (!CountsAreAllowed(encoding, CountMaxima(message)) || !TextsAreAllowed(encoding, message)) {
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
