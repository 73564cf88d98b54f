#include "msgs/message_decoder.h"

#include <type_traits>

#include "bus/authenticated_bus.h"
#include "core/bytes.h"

namespace fresco {
namespace {

using Fields = Description<transitions_t>;
constexpr size_t kIdentityEnd = Fields::transition_count_offset;  // the same in every message

template <class Integer>
Integer IntegerAt(std::span<const std::byte> bytes, size_t offset) {
  const auto value = bytes.subspan(offset, sizeof(Integer));
  return static_cast<Integer>(ReadBigEndian<std::make_unsigned_t<Integer>>(value.data()));
}

template <class... Message>
const char* NameOf(std::span<const std::byte> bytes, const std::tuple<Message...>*) {
  const char* name = nullptr;
  static_cast<void>(((BeginsAs<Message>(bytes) && (name = Message::getTypeName(), true)) || ...));
  return name;
}

RunIdentity IdentityAt(std::span<const std::byte> bytes) {
  return {IntegerAt<int64_t>(bytes, Fields::run_id_offset),
          static_cast<uint32_t>(IntegerAt<int64_t>(bytes, Fields::config_hash_offset))};
}

/// The size in bytes of a transitions_t with the counts that this encoding has.
size_t TransitionsBytes(std::span<const std::byte> encoding) {
  const auto count = [&](size_t offset) { return static_cast<size_t>(IntegerAt<int32_t>(encoding, offset)); };
  return Fields::EncodedBytes(count(Fields::transition_count_offset), count(Fields::state_count_offset),
                              count(Fields::field_count_offset), count(Fields::mask_size_offset));
}

}  // namespace

std::span<const std::byte> WithoutAuthentication(std::span<const std::byte> bytes) {
  return CarriesAuthentication(bytes) ? bytes.first(bytes.size() - kAuthenticationTagBytes) : bytes;
}

const char* PeekType(std::span<const std::byte> bytes) {
  return NameOf(bytes, static_cast<const MessageTypes*>(nullptr));
}

std::optional<RunIdentity> PeekIdentity(std::span<const std::byte> bytes) {
  if (bytes.size() < kIdentityEnd || PeekType(bytes) == nullptr) {
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
  if (!CountsAreAllowed(encoding, Fields::kCountMaxima) || encoding.size() != TransitionsBytes(encoding)) {
    return std::nullopt;
  }
  return TransitionsHeader{IdentityAt(encoding),
                           IntegerAt<int32_t>(encoding, Fields::transition_count_offset),
                           IntegerAt<int64_t>(encoding, Fields::order_index_offset),
                           IntegerAt<int64_t>(encoding, Fields::actor_id_offset),
                           IntegerAt<int32_t>(encoding, Fields::first_transition_offset),
                           IntegerAt<int32_t>(encoding, Fields::first_field_offset),
                           IntegerAt<int8_t>(encoding, Fields::ending_offset) != 0};
}

}  // namespace fresco
