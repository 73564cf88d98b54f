#include "bus/multicast_listener.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include "core/clock.h"
#include "core/error.h"

namespace fresco {
namespace {

// The limit of the memory for messages that wait for a handler that is slower than the network, and the
// overhead of each message. Beyond it, messages stay in the kernel's buffer. If that is full, the kernel
// drops and counts them.
constexpr size_t kMaximumArrivedBytes = size_t{128} << 20;
constexpr size_t kArrivedOverheadBytes = 128;

template <class Value>
bool SetOption(int descriptor, int level, int name, const Value& value) {
  return setsockopt(descriptor, level, name, &value, sizeof(value)) == 0;
}

int64_t ReceiveTime(msghdr& header) {
  for (cmsghdr* control = CMSG_FIRSTHDR(&header); control != nullptr;
       control = CMSG_NXTHDR(&header, control)) {
    if (control->cmsg_level == SOL_SOCKET && control->cmsg_type == SCM_TIMESTAMP) {
      timeval time{};
      std::memcpy(&time, CMSG_DATA(control), sizeof(time));
      return int64_t{time.tv_sec} * 1'000'000 + time.tv_usec;
    }
  }
  return WallMicroseconds();
}

}  // namespace

/// What the socket received. `datagram` is valid during the call only.
struct MulticastListener::Datagram {
  std::span<const std::byte> datagram;
  uint64_t sender;  ///< IPv4 address and port as one number
  int64_t utime;    ///< microseconds since the epoch, when the kernel received it
};

/// A socket that receives the datagrams sent to a multicast group, as LCM's own socket does. Only one thread
/// may use it.
class MulticastListener::Socket {
 public:
  /// Joins the group; from now on the kernel keeps arriving datagrams. Throws UsageError that says what to do
  /// if the group can't be joined.
  explicit Socket(const MulticastEndpoint& endpoint) : Socket() {
    const auto expect = [&](bool success, const char* call) {
      if (!success) {
        throw UsageError(fmt::format("can't listen on {}:{}: {}: {}; {}", endpoint.group, endpoint.port, call,
                                     std::strerror(errno), kMulticastRemedy));
      }
    };
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(endpoint.port);
    inet_pton(AF_INET, endpoint.group.c_str(), &address.sin_addr);
    const ip_mreq membership{.imr_multiaddr = address.sin_addr, .imr_interface = {htonl(INADDR_ANY)}};
    // The kernel may grant a smaller buffer, so that result is ignored. SO_REUSEADDR lets programs share the
    // port.
    SetOption(socket_, SOL_SOCKET, SO_RCVBUF, endpoint.receive_buffer_bytes);
    SetOption(socket_, SOL_SOCKET, SO_TIMESTAMP, 1);
    expect(SetOption(socket_, SOL_SOCKET, SO_REUSEADDR, 1), "SO_REUSEADDR");
    expect(bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0, "bind");
    expect(SetOption(socket_, IPPROTO_IP, IP_ADD_MEMBERSHIP, membership), "IP_ADD_MEMBERSHIP");
  }
  ~Socket() { close(socket_); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  int descriptor() const { return socket_; }

  /// Calls `take` for each datagram that has arrived, but at most for one batch. Does not wait.
  void Receive(const std::function<void(const Datagram&)>& take) {
    for (size_t i = 0; i < kBatchDatagrams; ++i) {
      Slot& slot = slots_[i];
      slot.datagram_vector = {slot.datagram.data(), slot.datagram.size()};
      headers_[i].msg_hdr = {.msg_name = &slot.sender,
                             .msg_namelen = sizeof(slot.sender),
                             .msg_iov = &slot.datagram_vector,
                             .msg_iovlen = 1,
                             .msg_control = slot.control.data(),
                             .msg_controllen = slot.control.size(),
                             .msg_flags = 0};
    }
    const int received = recvmmsg(socket_, headers_.data(), kBatchDatagrams, MSG_DONTWAIT, nullptr);
    for (size_t i = 0; static_cast<int>(i) < received; ++i) {
      const Slot& slot = slots_[i];
      take({std::span(slot.datagram).first(headers_[i].msg_len),
            uint64_t{slot.sender.sin_addr.s_addr} << 16 | slot.sender.sin_port,
            ReceiveTime(headers_[i].msg_hdr)});
    }
  }

 private:
  static constexpr size_t kBatchDatagrams = 32;
  static constexpr size_t kDatagramBytes = 65'536;  // the largest UDP datagram

  /// Buffers for a datagram, its sender and its time of arrival.
  struct Slot {
    std::array<std::byte, kDatagramBytes> datagram;
    iovec datagram_vector;
    sockaddr_in sender;
    alignas(cmsghdr) std::array<std::byte, CMSG_SPACE(sizeof(timeval))> control;
  };

  Socket() : socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {}

  int socket_;
  std::vector<Slot> slots_ = std::vector<Slot>(kBatchDatagrams);
  std::vector<mmsghdr> headers_ = std::vector<mmsghdr>(kBatchDatagrams);  // they point into slots_
};

EventDescriptor::EventDescriptor() : descriptor_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  FRESCO_CHECK(descriptor_ >= 0);
}

EventDescriptor::~EventDescriptor() {
  close(descriptor_);
}

void EventDescriptor::Set() {
  eventfd_write(descriptor_, 1);
}

void EventDescriptor::Clear() {
  eventfd_t value = 0;
  eventfd_read(descriptor_, &value);
}

MulticastListener::MulticastListener(const MulticastEndpoint& endpoint)
    : socket_(std::make_unique<Socket>(endpoint)),
      thread_([this](const std::stop_token& stop) { Listen(stop); }) {}

MulticastListener::~MulticastListener() = default;

bool MulticastListener::Hears(const std::string& channel, const std::function<void()>& send) {
  constexpr int64_t kPatienceUs = 10'000'000;
  constexpr int kSendAgainMs = 100;
  bool heard = false;
  const auto listen = [&](const LcmEvent& event) { heard = event.channel == channel; };
  const int64_t deadline_us = MonotonicMicroseconds() + kPatienceUs;
  while (!heard && MonotonicMicroseconds() < deadline_us) {
    send();
    const int64_t send_again_us = MonotonicMicroseconds() + 1000 * kSendAgainMs;
    while (!heard && MonotonicMicroseconds() < send_again_us) {
      pollfd readable{descriptor(), POLLIN, 0};
      poll(&readable, 1, has_left_over() ? 0 : kSendAgainMs);
      HandOut(listen, 1);
    }
  }
  handed_out_ = 0;
  return heard;
}

int MulticastListener::HandOut(const BusEventHandler& handler, int maximum) {
  if (taken_.empty()) {
    const std::lock_guard lock(mutex_);
    arrival_.Clear();
    std::swap(taken_, arrived_);
    arrived_bytes_ = 0;
    room_.notify_all();
  }
  int count = 0;
  while (count < maximum && !taken_.empty()) {
    const auto [utime, message] = std::move(taken_.front());
    taken_.pop_front();
    ++count;
    handler({handed_out_++, utime, message.channel, message.content});
  }
  return count;
}

UnheardTraffic MulticastListener::unheard() const {
  const std::lock_guard lock(mutex_);
  return unheard_;
}

/// The function of the listening thread.
void MulticastListener::Listen(const std::stop_token& stop) {
  const std::stop_callback wake(stop, [this] { end_.Set(); });
  while (!stop.stop_requested()) {
    std::array<pollfd, 2> readable = {{{socket_->descriptor(), POLLIN, 0}, {end_.descriptor(), POLLIN, 0}}};
    poll(readable.data(), readable.size(), -1);
    socket_->Receive([this](const Datagram& received) { Assemble(received); });
    std::unique_lock lock(mutex_);
    room_.wait(lock, stop, [this] { return arrived_bytes_ < kMaximumArrivedBytes; });
  }
}

void MulticastListener::Assemble(const Datagram& received) {
  auto message = assembler_.Add(received.datagram, received.sender, received.utime);
  const std::lock_guard lock(mutex_);
  unheard_ = {assembler_.refused_datagrams(), assembler_.incomplete_messages()};
  if (message) {
    arrived_bytes_ += message->content.size() + kArrivedOverheadBytes;
    if (arrived_.empty()) {
      arrival_.Set();
    }
    arrived_.push_back({received.utime, std::move(*message)});
  }
}

}  // namespace fresco
