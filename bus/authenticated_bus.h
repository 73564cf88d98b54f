// A bus that accepts only messages from senders with the same key. It wraps another bus. It appends a tag to
// every message that it publishes: the keyed BLAKE2b-256 of the channel's name, a zero byte and the content.
// It counts and drops every arriving message whose tag is wrong or missing, before any handler sees it. The
// content is not changed, so LCM's own tools still read the messages.
//
// The tag proves that the sender has the key, and that nobody changed the message or moved it to another
// channel. It does not encrypt, and it does not stop anybody from sending an old message again: see
// docs/reliability.md.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "bus/authentication_key.h"
#include "bus/bus.h"

namespace fresco {

inline constexpr size_t kAuthenticationTagBytes = 32;

/// Takes a message as it is on the wire or in a log, and returns its content without the tag if the tag is
/// right for this key and channel; otherwise nullopt. The time of the comparison does not depend on the
/// bytes. Any thread may call it.
std::optional<std::span<const std::byte>> AuthenticContent(const AuthenticationKey& key,
                                                           std::string_view channel,
                                                           std::span<const std::byte> message);

/// Returns a bus that authenticates all messages to and from `inner`. `inner` must outlive it, and must not
/// be polled after it is destroyed. Threads may use it as they may use any bus. Receiving does not allocate.
std::unique_ptr<Bus> MakeAuthenticatedBus(Bus& inner, const AuthenticationKey& key);

/// Does the same, and owns `inner`.
std::unique_ptr<Bus> MakeAuthenticatedBus(std::unique_ptr<Bus> inner, const AuthenticationKey& key);

}  // namespace fresco
