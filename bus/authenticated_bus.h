// A decorator that lets only messages of those who hold a key through. Behind every message that it
// publishes stands a tag, the keyed BLAKE2b-256 of the channel's name, a zero byte and the content; a
// message that arrives without the tag of its channel and content is counted and dropped before any
// handler sees it. The content itself is not changed, so LCM's own tools still read the messages.
//
// It proves that a message came from somebody with the key and was not changed or moved to another
// channel. It hides nothing, and an old message that is sent again passes: see docs/reliability.md.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "bus/authentication_key.h"
#include "bus/bus.h"

namespace fresco {

inline constexpr size_t kAuthenticationTagBytes = 32;

/// The content of a message as it stands on the wire or in a log, where the tag behind it is that of this key
/// and channel; nullopt otherwise. Compares in a time that does not depend on where they differ. Thread-safe.
std::optional<std::span<const std::byte>> AuthenticContent(const AuthenticationKey& key,
                                                           std::string_view channel,
                                                           std::span<const std::byte> message);

/// Authenticates what passes to and from `inner`, which must outlive the decorator and must not be polled
/// after its end. Threads as of any bus; receiving allocates nothing.
std::unique_ptr<Bus> MakeAuthenticatedBus(Bus& inner, const AuthenticationKey& key);

/// The same with a bus of its own.
std::unique_ptr<Bus> MakeAuthenticatedBus(std::unique_ptr<Bus> inner, const AuthenticationKey& key);

}  // namespace fresco
