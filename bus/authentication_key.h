// The secret that the programs of one run share; see bus/authenticated_bus.h. A plain value whose bytes
// are wiped when it ends; each copy is wiped by itself.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>

namespace fresco {

class AuthenticationKey {
 public:
  static constexpr size_t kBytes = 32;

  /// The key of a secret of any length: its BLAKE2b-256.
  explicit AuthenticationKey(std::span<const std::byte> secret);
  ~AuthenticationKey();
  AuthenticationKey(const AuthenticationKey&) = default;
  AuthenticationKey& operator=(const AuthenticationKey&) = default;

  std::span<const unsigned char, kBytes> bytes() const { return bytes_; }

 private:
  std::array<unsigned char, kBytes> bytes_{};
};

/// Where the key is; none: messages are not authenticated.
using KeyFile = std::optional<std::filesystem::path>;

inline constexpr size_t kMinimumKeyFileBytes = 32;
inline constexpr size_t kMaximumKeyFileBytes = 65536;

/// The key of a file's whole content. Throws UsageError where the file can't be read, is shorter than
/// kMinimumKeyFileBytes or longer than kMaximumKeyFileBytes, or may be read or written by others than its
/// owner; the text names the file and the command that makes a key or mends this one.
AuthenticationKey ReadAuthenticationKey(const std::filesystem::path& path);

}  // namespace fresco
