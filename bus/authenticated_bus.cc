#include "bus/authenticated_bus.h"

#include <sodium.h>

#include <array>
#include <atomic>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace fresco {
namespace {

using Tag = std::array<unsigned char, kAuthenticationTagBytes>;

const unsigned char* Data(std::span<const std::byte> bytes) {
  return reinterpret_cast<const unsigned char*>(bytes.data());
}

const Tag& TagOf(const AuthenticationKey& key, std::string_view channel, std::span<const std::byte> content,
                 Tag& tag) {
  constexpr unsigned char kEndOfChannel = 0;  // so that "ab" + "c" and "a" + "bc" have different tags
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
    const auto tag = std::as_bytes(std::span(TagOf(key_, channel, message, published_tag_)));
    published_.assign(message.begin(), message.end());
    published_.insert(published_.end(), tag.begin(), tag.end());
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
  std::mutex publish_mutex_;  // guards published_ and published_tag_
  std::vector<std::byte> published_;
  Tag published_tag_{};
  std::atomic<int64_t> refused_ = 0;
};

}  // namespace

std::optional<std::span<const std::byte>> AuthenticContent(const AuthenticationKey& key,
                                                           std::string_view channel,
                                                           std::span<const std::byte> message) {
  if (message.size() < kAuthenticationTagBytes) {
    return std::nullopt;
  }
  const auto content = message.first(message.size() - kAuthenticationTagBytes);
  Tag expected;
  TagOf(key, channel, content, expected);
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
