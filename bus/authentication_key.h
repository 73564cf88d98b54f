// The secret key that the programs of one run share; see bus/authenticated_bus.h. A plain value. Its
// destructor overwrites the bytes with zeros; so does that of each copy.
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

}  // namespace fresco
