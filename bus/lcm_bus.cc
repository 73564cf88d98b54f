#include <fmt/format.h>
#include <lcm/lcm.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "bus/bus.h"
#include "bus/lcm_url.h"
#include "bus/message_assembler.h"
#include "bus/multicast_listener.h"
#include "bus/receive_filter.h"
#include "core/error.h"

namespace fresco {
namespace {

/// Escapes the characters that are special in a regular expression, since LCM reads channel names as such.
std::string EscapeChannel(const std::string& channel) {
  std::string escaped;
  for (const char c : channel) {
    if (std::string_view(".^$|()[]{}*+?\\").find(c) != std::string_view::npos) {
      escaped += '\\';
    }
    escaped += c;
  }
  return escaped;
}

void CheckChannel(const std::string& channel) {
  if (channel.size() > kMaximumLcmChannelBytes || channel.find('\0') != std::string::npos) {
    throw UsageError(fmt::format(
        "LCM channel \"{}\": expected a name of up to {} bytes without a zero byte, found {} bytes", channel,
        kMaximumLcmChannelBytes, channel.size()));
  }
}

std::string Remedy(const std::string& url) {
  if (url.starts_with("tcpq")) {
    return "no LCM TCP server answers there; start one with: java -cp /usr/share/java/lcm.jar "
           "lcm.lcm.TCPService PORT";
  }
  return kMulticastRemedy;
}

struct LcmDestroyer {
  void operator()(lcm_t* lcm) const { lcm_destroy(lcm); }
};
using Lcm = std::unique_ptr<lcm_t, LcmDestroyer>;

class LcmBus : public Bus {
 public:
  explicit LcmBus(const std::string& url) : url_(ParseLcmUrl(url)), lcm_(lcm_create(url_.text.c_str())) {
    // With tcpq LCM reports success although nobody answers; there is no descriptor then.
    if (lcm_ == nullptr || (!url_.multicast && lcm_get_fileno(lcm_.get()) < 0)) {
      throw UsageError(fmt::format("can't open the LCM URL {}: {}", url_.text, Remedy(url_.text)));
    }
  }

  ~LcmBus() override {
    const std::lock_guard lock(ReceivingSockets());
    listener_.reset();
    lcm_.reset();
  }

  LcmBus(const LcmBus&) = delete;
  LcmBus& operator=(const LcmBus&) = delete;

  bool Publish(const std::string& channel, std::span<const std::byte> message) override {
    const std::lock_guard lock(publish_mutex_);  // LCM's tcpq provider is not thread-safe here
    return lcm_publish(lcm_.get(), channel.c_str(), message.data(), static_cast<unsigned>(message.size())) ==
           0;
  }

  void Subscribe(const std::string& channel, BusHandler handler, int queue_capacity) override {
    CheckChannel(channel);
    if (url_.multicast) {
      LetThrough(channel);
    }
    SubscribeTo(
        EscapeChannel(channel),
        [handler = std::move(handler)](const LcmEvent& event) { handler(event.message); }, queue_capacity);
  }

  void SubscribeToAll(BusEventHandler handler) override {
    if (url_.multicast) {
      Listen();
      hear_all_ = std::move(handler);
    } else {
      SubscribeTo(".*", std::move(handler), kDefaultQueueCapacity);
    }
  }

  int Poll(int64_t timeout_us, int maximum_messages) override {
    int handled = 0;
    while (handled < maximum_messages) {
      const Readable readable = WaitReadable(handled == 0 ? timeout_us : 0);
      if (!readable.lcm && !readable.listener) {
        break;
      }
      handled += readable.lcm ? HandleOne() : 0;
      handled += readable.listener ? listener_->HandOut(hear_all_, maximum_messages - handled) : 0;
    }
    return handled;
  }

  UnheardTraffic unheard() const override { return listener_ ? listener_->unheard() : UnheardTraffic{}; }

 private:
  struct Subscription {
    LcmBus* bus;
    BusEventHandler handler;
    int64_t received = 0;
  };

  struct Readable {
    bool lcm;
    bool listener;
  };

  /// Lets LCM receive messages of this channel. Makes LCM open its socket if it has none yet; until the
  /// filter is attached, LCM reads everything that arrives on it.
  void LetThrough(const std::string& channel) {
    if (!filter_) {
      const std::lock_guard lock(ReceivingSockets());
      filter_.emplace(SocketOpenedBy(
          [&] {
            if (lcm_get_fileno(lcm_.get()) < 0) {
              RefuseToSubscribe(channel);
            }
          },
          url_.multicast->port));
    }
    filter_->Pass(channel);
  }

  void Listen() {
    FRESCO_CHECK(listener_ == nullptr);
    {
      const std::lock_guard lock(ReceivingSockets());
      listener_ = std::make_unique<MulticastListener>(*url_.multicast);
    }
    // LCM sends the same message to itself when it opens its socket.
    const std::string channel = "LCM_SELF_TEST";
    const std::string_view content = "lcm self test";
    if (!listener_->Hears(channel, [&] { Publish(channel, std::as_bytes(std::span(content))); })) {
      RefuseToSubscribe("all channels");
    }
  }

  [[noreturn]] void RefuseToSubscribe(const std::string& channels) const {
    throw UsageError(
        fmt::format("LCM can't subscribe to {} on {}: multicast packets that it sends do not come back; a "
                    "firewall may drop them (allow UDP to 224.0.0.0/4), or {}",
                    channels, url_.text, Remedy(url_.text)));
  }

  void SubscribeTo(const std::string& channels, BusEventHandler handler, int queue_capacity) {
    Subscription& subscription = subscriptions_.emplace_back(Subscription{this, std::move(handler)});
    lcm_subscription_t* raw = lcm_subscribe(lcm_.get(), channels.c_str(), &LcmBus::Dispatch, &subscription);
    if (raw == nullptr) {
      RefuseToSubscribe(channels);
    }
    lcm_subscription_set_queue_capacity(raw, queue_capacity);
  }

  static void Dispatch(const lcm_recv_buf_t* buffer, const char* channel, void* user) {
    auto* subscription = static_cast<Subscription*>(user);
    try {
      subscription->handler({subscription->received++,
                             buffer->recv_utime,
                             channel,
                             {static_cast<const std::byte*>(buffer->data), buffer->data_size}});
    } catch (...) {
      subscription->bus->exception_ = std::current_exception();
    }
  }

  int HandleOne() {
    if (lcm_handle(lcm_.get()) != 0) {
      throw Failure("the connection of " + url_.text + " was lost");
    }
    if (exception_) {
      std::rethrow_exception(std::exchange(exception_, nullptr));
    }
    return 1;
  }

  /// The descriptor that becomes readable when LCM has a message. -1 if LCM does not receive yet; LCM must
  /// not be asked for it then, since it would open its socket.
  int LcmDescriptor() const {
    if (url_.multicast && !filter_) {
      return -1;
    }
    const int descriptor = lcm_get_fileno(lcm_.get());
    if (descriptor < 0) {
      throw Failure("the connection of " + url_.text + " was lost");
    }
    return descriptor;
  }

  Readable WaitReadable(int64_t timeout_us) const {
    constexpr int64_t kMicrosecondsPerSecond = 1'000'000;
    const bool left_over = listener_ && listener_->has_left_over();
    std::array<pollfd, 2> descriptors = {
        {{LcmDescriptor(), POLLIN, 0}, {listener_ ? listener_->descriptor() : -1, POLLIN, 0}}};
    const int64_t wait_us = left_over ? 0 : std::max<int64_t>(timeout_us, 0);
    const timespec timeout{wait_us / kMicrosecondsPerSecond, wait_us % kMicrosecondsPerSecond * 1000};
    const bool any = ppoll(descriptors.data(), descriptors.size(), &timeout, nullptr) > 0;
    return {any && descriptors[0].revents != 0, left_over || (any && descriptors[1].revents != 0)};
  }

  LcmUrl url_;
  std::mutex publish_mutex_;
  std::deque<Subscription> subscriptions_;  // a deque, since LCM holds pointers to the elements
  std::exception_ptr exception_;
  Lcm lcm_;
  std::optional<ReceiveFilter> filter_;  // set if the URL is udpm and LCM receives
  BusEventHandler hear_all_;             // the handler for the listener's messages
  std::unique_ptr<MulticastListener> listener_;
};

}  // namespace

std::unique_ptr<Bus> OpenLcmBus(const std::string& url) {
  return std::make_unique<LcmBus>(url);
}

}  // namespace fresco
