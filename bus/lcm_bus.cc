#include <fmt/format.h>
#include <lcm/lcm.h>
#include <poll.h>

#include <algorithm>
#include <deque>
#include <exception>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "bus/bus.h"
#include "bus/lcm_url.h"
#include "bus/receive_filter.h"
#include "core/error.h"

namespace fresco {
namespace {

/// LCM reads channel names as regular expressions: escapes what is special in one.
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
  constexpr size_t kLongest = 63;  // LCM's
  if (channel.size() > kLongest || channel.find('\0') != std::string::npos) {
    throw UsageError(fmt::format(
        "LCM channel \"{}\": expected a name of up to {} bytes without a zero byte, found {} bytes", channel,
        kLongest, channel.size()));
  }
}

std::string Remedy(const std::string& url) {
  if (url.starts_with("tcpq")) {
    return "no LCM TCP server answers there; start one with: java -cp /usr/share/java/lcm.jar "
           "lcm.lcm.TCPService PORT";
  }
  return "most likely no route covers multicast; as root: ip route add 224.0.0.0/4 dev lo (as another user: "
         "unshare -Urn, then the same inside, after ip link set lo up), or the port is taken by another "
         "program";
}

struct LcmDestroyer {
  void operator()(lcm_t* lcm) const { lcm_destroy(lcm); }
};
using Lcm = std::unique_ptr<lcm_t, LcmDestroyer>;

/// With the socket that it receives with, and its own thread reading from it.
Lcm OpenLcm(const std::string& url) {
  Lcm lcm(lcm_create(url.c_str()));
  // With tcpq LCM reports success although nobody answers; there is no descriptor then.
  if (lcm == nullptr || lcm_get_fileno(lcm.get()) < 0) {
    throw UsageError(fmt::format("can't open the LCM URL {}: {}", url, Remedy(url)));
  }
  return lcm;
}

class LcmBus : public Bus {
 public:
  explicit LcmBus(const std::string& url) : url_(NormalizeLcmUrl(url)) {
    const auto port = MulticastPort(url_);
    if (!port) {
      lcm_ = OpenLcm(url_);
      return;
    }
    const std::lock_guard lock(Sockets());
    const std::vector<int> before = ReceivingSockets(*port);
    lcm_ = OpenLcm(url_);
    std::vector<int> opened = ReceivingSockets(*port);
    std::erase_if(
        opened, [&](int socket) { return std::find(before.begin(), before.end(), socket) != before.end(); });
    if (opened.size() != 1) {
      throw Failure(fmt::format("{}: expected one new socket on UDP port {}, LCM's own, found {}", url_,
                                *port, opened.size()));
    }
    filter_.emplace(opened.front());
  }

  ~LcmBus() override {
    const std::lock_guard lock(Sockets());
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
    if (filter_) {
      filter_->Pass(channel);
    }
    SubscribeTo(
        EscapeChannel(channel),
        [handler = std::move(handler)](const LcmEvent& event) { handler(event.message); }, queue_capacity);
  }

  void SubscribeToAll(BusEventHandler handler, int queue_capacity) override {
    if (filter_) {
      filter_->PassAll();
    }
    SubscribeTo(".*", std::move(handler), queue_capacity);
  }

  int Poll(int64_t timeout_us, int maximum_messages) override {
    int handled = 0;
    while (handled < maximum_messages && WaitReadable(handled == 0 ? timeout_us : 0)) {
      if (lcm_handle(lcm_.get()) != 0) {
        throw Failure("the connection of " + url_ + " was lost");
      }
      ++handled;
      if (exception_) {
        std::rethrow_exception(std::exchange(exception_, nullptr));
      }
    }
    return handled;
  }

 private:
  struct Subscription {
    LcmBus* bus;
    BusEventHandler handler;
    int64_t received = 0;
  };

  /// LCM does not tell which socket is its own: held while a bus opens or closes one.
  static std::mutex& Sockets() {
    static std::mutex sockets;
    return sockets;
  }

  void SubscribeTo(const std::string& channels, BusEventHandler handler, int queue_capacity) {
    Subscription& subscription = subscriptions_.emplace_back(Subscription{this, std::move(handler)});
    lcm_subscription_t* raw = lcm_subscribe(lcm_.get(), channels.c_str(), &LcmBus::Dispatch, &subscription);
    if (raw == nullptr) {
      throw UsageError(
          fmt::format("LCM can't subscribe to {} on {}: multicast packets do not come back; a firewall "
                      "may drop them (allow UDP to 224.0.0.0/4), or {}",
                      channels, url_, Remedy(url_)));
    }
    lcm_subscription_set_queue_capacity(raw, queue_capacity);
  }

  /// LCM 1.3.1 says that a datagram which ends before its channel's name does has -1 bytes of content, or
  /// fewer.
  static std::span<const std::byte> Content(const lcm_recv_buf_t& buffer) {
    const bool whole = buffer.data_size <= static_cast<uint32_t>(std::numeric_limits<int32_t>::max());
    return {static_cast<const std::byte*>(buffer.data), whole ? buffer.data_size : 0};
  }

  static void Dispatch(const lcm_recv_buf_t* buffer, const char* channel, void* user) {
    auto* subscription = static_cast<Subscription*>(user);
    try {
      subscription->handler({subscription->received++, buffer->recv_utime, channel, Content(*buffer)});
    } catch (...) {
      subscription->bus->exception_ = std::current_exception();
    }
  }

  bool WaitReadable(int64_t timeout_us) const {
    constexpr int64_t kMicrosecondsPerSecond = 1'000'000;
    pollfd descriptor{lcm_get_fileno(lcm_.get()), POLLIN, 0};
    if (descriptor.fd < 0) {
      throw Failure("the connection of " + url_ + " was lost");
    }
    const int64_t wait_us = timeout_us > 0 ? timeout_us : 0;
    const timespec timeout{wait_us / kMicrosecondsPerSecond, wait_us % kMicrosecondsPerSecond * 1000};
    return ppoll(&descriptor, 1, &timeout, nullptr) > 0;
  }

  std::string url_;
  std::mutex publish_mutex_;
  std::deque<Subscription> subscriptions_;  // stable addresses: LCM holds them
  std::exception_ptr exception_;
  Lcm lcm_;
  std::optional<ReceiveFilter> filter_;  // with udpm
};

}  // namespace

std::unique_ptr<Bus> OpenLcmBus(const std::string& url) {
  return std::make_unique<LcmBus>(url);
}

}  // namespace fresco
