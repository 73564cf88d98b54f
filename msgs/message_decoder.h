// Decodes whatever stands in a log or on a bus, by the fingerprint with which LCM begins every message: for
// those who look at all of it. Programs of a run know what to expect on a channel and use msgs/wire.h.
// An object belongs to one thread; it keeps its messages, so that it allocates nothing after a while.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>

#include "core/big_endian.h"
#include "msgs/wire.h"

namespace fresco {

/// The message without the tag behind it, where it carries one (see CarriesAuthentication). Checks no key.
std::span<const std::byte> WithoutAuthentication(std::span<const std::byte> bytes);

/// Whether the bytes begin with the fingerprint of this type. LCM's own, which covers every field.
template <class Message>
bool BeginsAs(std::span<const std::byte> bytes) {
  return bytes.size() >= sizeof(uint64_t) &&
         ReadBigEndian<uint64_t>(bytes.data()) == static_cast<uint64_t>(Message::getHash());
}

class MessageDecoder {
 public:
  enum class Result {
    kDecoded,  ///< and handed to the handler
    kDamaged,  ///< begins as one of Fresco's, and does not decode
    kForeign,  ///< none of Fresco's
  };

  /// Calls `handler(const Message&)` for what the bytes are, with or without an authentication tag behind
  /// them. The message is valid until the next call.
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

}  // namespace fresco
