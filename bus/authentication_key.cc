#include "bus/authentication_key.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sodium.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>

#include "core/error.h"

namespace fresco {
namespace {

static_assert(AuthenticationKey::kBytes == crypto_generichash_KEYBYTES);

void InitialiseSodium() {
  if (sodium_init() < 0) {
    throw Failure("libsodium can't be initialised");
  }
}

[[noreturn]] void Refuse(const std::filesystem::path& path, const std::string& problem) {
  throw UsageError(
      fmt::format("--key-file: {}: {}; make a key with: (umask 077; head -c 32 /dev/urandom > '{}')",
                  path.string(), problem, path.string()));
}

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// Opens the file without a stream buffer, so that no copy of the secret stays in memory. O_NONBLOCK lets a
/// pipe without a writer be refused; otherwise open would wait for one.
File OpenUnbuffered(const std::filesystem::path& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  File file(descriptor < 0 ? nullptr : fdopen(descriptor, "rb"), &std::fclose);
  if (file == nullptr) {
    Refuse(path, fmt::format("can't be read: {}", std::strerror(errno)));
  }
  std::setvbuf(file.get(), nullptr, _IONBF, 0);
  return file;
}

/// Checks the open file itself, since the path may name another file by now.
void CheckKindAndMode(const File& file, const std::filesystem::path& path) {
  struct stat status {};
  if (fstat(fileno(file.get()), &status) != 0 || !S_ISREG(status.st_mode)) {
    Refuse(path, "expected a regular file, found a directory, a device or a pipe");
  }
  constexpr mode_t kOthers = S_IRWXG | S_IRWXO;
  if ((status.st_mode & kOthers) != 0) {
    throw UsageError(
        fmt::format("--key-file: {}: expected a file of its owner alone (mode 600), found mode {:o}: others "
                    "may know this key; chmod 600 '{}', or make another key",
                    path.string(), status.st_mode & 07777, path.string()));
  }
}

}  // namespace

AuthenticationKey::AuthenticationKey(std::span<const std::byte> secret) {
  InitialiseSodium();
  crypto_generichash(bytes_.data(), bytes_.size(), reinterpret_cast<const unsigned char*>(secret.data()),
                     secret.size(), nullptr, 0);
}

AuthenticationKey::~AuthenticationKey() {
  sodium_memzero(bytes_.data(), bytes_.size());
}

AuthenticationKey ReadAuthenticationKey(const std::filesystem::path& path) {
  InitialiseSodium();
  const File file = OpenUnbuffered(path);
  CheckKindAndMode(file, path);
  constexpr size_t kRoom = kMaximumKeyFileBytes + 1;
  const std::unique_ptr<std::byte, void (*)(void*)> secret(static_cast<std::byte*>(sodium_malloc(kRoom)),
                                                           &sodium_free);  // wipes it
  if (secret == nullptr) {
    throw Failure("no memory for the key");
  }
  const size_t size = std::fread(secret.get(), 1, kRoom, file.get());
  if (std::ferror(file.get()) != 0) {
    Refuse(path, fmt::format("can't be read: {}", std::strerror(errno)));
  }
  if (size < kMinimumKeyFileBytes || size > kMaximumKeyFileBytes) {
    Refuse(path, fmt::format("expected {} to {} bytes, found {}", kMinimumKeyFileBytes, kMaximumKeyFileBytes,
                             size < kRoom ? std::to_string(size) : "more"));
  }
  return AuthenticationKey({secret.get(), size});
}

}  // namespace fresco
