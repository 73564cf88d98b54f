#include "msgs/message_peek.h"

#include <type_traits>

namespace fresco {
namespace {

// Behind LCM's fingerprint: utime, run_id, config_hash, then every count.
constexpr size_t kRunIdOffset = 16;
constexpr size_t kConfigHashOffset = 24;
constexpr size_t kCountsOffset = 32;

template <class Integer>
Integer IntegerAt(std::span<const std::byte> bytes, size_t offset) {
  std::make_unsigned_t<Integer> value = 0;
  for (const std::byte byte : bytes.subspan(offset, sizeof(Integer))) {
    value = static_cast<std::make_unsigned_t<Integer>>(value << 8 |
                                                       std::to_integer<std::make_unsigned_t<Integer>>(byte));
  }
  return static_cast<Integer>(value);
}

template <class... Message>
const char* NameOf(std::span<const std::byte> bytes, const std::tuple<Message...>*) {
  const char* name = nullptr;
  static_cast<void>(((BeginsAs<Message>(bytes) && (name = Message::getTypeName(), true)) || ...));
  return name;
}

RunIdentity IdentityAt(std::span<const std::byte> bytes) {
  return {IntegerAt<int64_t>(bytes, kRunIdOffset),
          static_cast<uint32_t>(IntegerAt<int64_t>(bytes, kConfigHashOffset))};
}

/// The bytes of a transitions_t of these counts, as its .lcm file lists them.
size_t TransitionsBytes(std::span<const std::byte> encoding) {
  const auto count = [&](size_t place) {
    return static_cast<size_t>(IntegerAt<int32_t>(encoding, kCountsOffset + 4 * place));
  };
  constexpr size_t kFixedBytes = kCountsOffset + 4 * 4 + 8 + 8 + 4 + 1;
  const size_t state_bytes = 3 * 2 + 4 + 2 * count(2);
  const size_t transition_bytes = 2 + 4 + 4 + count(3);
  return kFixedBytes + count(1) * state_bytes + count(0) * transition_bytes;
}

}  // namespace

const char* PeekType(std::span<const std::byte> bytes) {
  return NameOf(bytes, static_cast<const MessageTypes*>(nullptr));
}

std::optional<RunIdentity> PeekIdentity(std::span<const std::byte> bytes) {
  if (bytes.size() < kCountsOffset || PeekType(bytes) == nullptr) {
    return std::nullopt;
  }
  return IdentityAt(bytes);
}

std::optional<TransitionsHeader> PeekTransitions(std::span<const std::byte> bytes) {
  if (!BeginsAs<transitions_t>(bytes)) {
    return std::nullopt;
  }
  std::span<const std::byte> encoding = WithoutTrailer(bytes);
  if (encoding.empty()) {
    encoding = WithoutTrailer(WithoutAuthentication(bytes));
  }
  constexpr size_t kOrderOffset = kCountsOffset + 4 * 4;
  if (!CountsAreAllowed(encoding, CountMaxima(transitions_t{})) ||
      encoding.size() != TransitionsBytes(encoding)) {
    return std::nullopt;
  }
  return TransitionsHeader{IdentityAt(encoding),
                           IntegerAt<int32_t>(encoding, kCountsOffset),
                           IntegerAt<int64_t>(encoding, kOrderOffset),
                           IntegerAt<int64_t>(encoding, kOrderOffset + 8),
                           IntegerAt<int32_t>(encoding, kOrderOffset + 16),
                           IntegerAt<int8_t>(encoding, kOrderOffset + 20) != 0};
}

}  // namespace fresco
