#include "bus/authenticated_bus.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sodium.h>
#include <sys/stat.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"

namespace fresco {
namespace {

static_assert(AuthenticationKey::kBytes == crypto_generichash_KEYBYTES);

void InitialiseSodium() {
  if (sodium_init() < 0) {
    throw Failure("libsodium can't be initialised");
  }
}

[[noreturn]] void RefuseKeyFile(const std::filesystem::path& path, const std::string& problem) {
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
    RefuseKeyFile(path, fmt::format("can't be read: {}", std::strerror(errno)));
  }
  std::setvbuf(file.get(), nullptr, _IONBF, 0);
  return file;
}

/// Checks the open file itself, since the path may name another file by now.
void CheckKindAndMode(const File& file, const std::filesystem::path& path) {
  struct stat status {};
  if (fstat(fileno(file.get()), &status) != 0 || !S_ISREG(status.st_mode)) {
    RefuseKeyFile(path, "expected a regular file, found a directory, a device or a pipe");
  }
  constexpr mode_t kOthers = S_IRWXG | S_IRWXO;
  if ((status.st_mode & kOthers) != 0) {
    throw UsageError(
        fmt::format("--key-file: {}: expected a file of its owner alone (mode 600), found mode {:o}: others "
                    "may know this key; chmod 600 '{}', or make another key",
                    path.string(), status.st_mode & 07777, path.string()));
  }
}

using Tag = std::array<unsigned char, kAuthenticationTagBytes>;

const unsigned char* Data(std::span<const std::byte> bytes) {
  return reinterpret_cast<const unsigned char*>(bytes.data());
}

Tag TagOf(const AuthenticationKey& key, std::string_view channel, std::span<const std::byte> content) {
  constexpr unsigned char kEndOfChannel = 0;  // so that "ab" + "c" and "a" + "bc" have different tags
  Tag tag;
  crypto_generichash_state state;
  crypto_generichash_init(&state, key.bytes().data(), key.bytes().size(), tag.size());
  crypto_generichash_update(&state, Data(std::as_bytes(std::span(channel))), channel.size());
  crypto_generichash_update(&state, &kEndOfChannel, 1);
  crypto_generichash_update(&state, Data(content), content.size());
  crypto_generichash_final(&state, tag.data(), tag.size());
  return tag;
}

class AuthenticatedBus : public Bus {
 public:
  AuthenticatedBus(Bus& inner, const AuthenticationKey& key) : inner_(&inner), key_(key) {}
  AuthenticatedBus(std::unique_ptr<Bus> inner, const AuthenticationKey& key)
      : owned_(std::move(inner)), inner_(owned_.get()), key_(key) {}

  bool Publish(const std::string& channel, std::span<const std::byte> message) override {
    const std::lock_guard lock(publish_mutex_);
    const Tag tag = TagOf(key_, channel, message);
    const auto tag_bytes = std::as_bytes(std::span(tag));
    published_.assign(message.begin(), message.end());
    published_.insert(published_.end(), tag_bytes.begin(), tag_bytes.end());
    return inner_->Publish(channel, published_);
  }

  void Subscribe(const std::string& channel, BusHandler handler, int queue_capacity) override {
    const auto authenticate = [this, channel,
                               handler = std::move(handler)](std::span<const std::byte> message) {
      if (const auto content = AuthenticContent(key_, channel, message)) {
        handler(*content);
      } else {
        refused_.fetch_add(1, std::memory_order_relaxed);
      }
    };
    inner_->Subscribe(channel, authenticate, queue_capacity);
  }

  void SubscribeToAll(BusEventHandler handler) override { inner_->SubscribeToAll(std::move(handler)); }

  int Poll(int64_t timeout_us, int maximum_messages) override {
    return inner_->Poll(timeout_us, maximum_messages);
  }

  int64_t refused_messages() const override {
    return inner_->refused_messages() + refused_.load(std::memory_order_relaxed);
  }

  UnheardTraffic unheard() const override { return inner_->unheard(); }

 private:
  std::unique_ptr<Bus> owned_;  // null if this object does not own inner_
  Bus* inner_;
  AuthenticationKey key_;
  std::mutex publish_mutex_;  // guards published_
  std::vector<std::byte> published_;
  std::atomic<int64_t> refused_ = 0;
};

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
    RefuseKeyFile(path, fmt::format("can't be read: {}", std::strerror(errno)));
  }
  if (size < kMinimumKeyFileBytes || size > kMaximumKeyFileBytes) {
    RefuseKeyFile(path, fmt::format("expected {} to {} bytes, found {}", kMinimumKeyFileBytes,
                                    kMaximumKeyFileBytes, size < kRoom ? std::to_string(size) : "more"));
  }
  return AuthenticationKey({secret.get(), size});
}

std::optional<std::span<const std::byte>> AuthenticContent(const AuthenticationKey& key,
                                                           std::string_view channel,
                                                           std::span<const std::byte> message) {
  if (message.size() < kAuthenticationTagBytes) {
    return std::nullopt;
  }
  const auto content = message.first(message.size() - kAuthenticationTagBytes);
  const Tag expected = TagOf(key, channel, content);
  const bool holds = sodium_memcmp(expected.data(), Data(message.last(kAuthenticationTagBytes)),
                                   kAuthenticationTagBytes) == 0;
  return holds ? std::optional(content) : std::nullopt;
}

std::unique_ptr<Bus> MakeAuthenticatedBus(Bus& inner, const AuthenticationKey& key) {
  return std::make_unique<AuthenticatedBus>(inner, key);
}

std::unique_ptr<Bus> MakeAuthenticatedBus(std::unique_ptr<Bus> inner, const AuthenticationKey& key) {
  return std::make_unique<AuthenticatedBus>(std::move(inner), key);
}

}  // namespace fresco
