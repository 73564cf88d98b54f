// A bus that accepts only messages from senders with the same key. It wraps another bus. It appends a tag to
// every message that it publishes: the keyed BLAKE2b-256 of the channel's name, a zero byte and the content.
// It counts and drops every arriving message whose tag is wrong or missing, before any handler sees it. The
// content is not changed, so LCM's own tools still read the messages.
//
// The tag proves that the sender has the key, and that nobody changed the message or moved it to another
// channel. It does not encrypt, and it does not stop anybody from sending an old message again: see
// docs/reliability.md.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "bus/bus.h"

namespace fresco {

/// The secret key that the programs of one run share. A plain value. Its destructor overwrites the bytes with
/// zeros; so does that of each copy.
class AuthenticationKey {
 public:
  static constexpr size_t kBytes = 32;

  /// Derives the key from a secret of any length: the key is the secret's BLAKE2b-256.
  explicit AuthenticationKey(std::span<const std::byte> secret);
  ~AuthenticationKey();
  AuthenticationKey(const AuthenticationKey&) = default;
  AuthenticationKey& operator=(const AuthenticationKey&) = default;

  std::span<const unsigned char, kBytes> bytes() const { return bytes_; }

 private:
  std::array<unsigned char, kBytes> bytes_{};
};

/// The path of the key file; none if messages are not authenticated.
using KeyFile = std::optional<std::filesystem::path>;

inline constexpr size_t kMinimumKeyFileBytes = 32;
inline constexpr size_t kMaximumKeyFileBytes = 65536;

/// Returns the key derived from the whole content of a file. Throws UsageError if the file can't be read, is
/// shorter than kMinimumKeyFileBytes or longer than kMaximumKeyFileBytes, or if users other than its owner
/// may read or write it. The error names the file and a command that makes a key or corrects the file's mode.
AuthenticationKey ReadAuthenticationKey(const std::filesystem::path& path);

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
