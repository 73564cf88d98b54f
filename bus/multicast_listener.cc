#include "bus/multicast_listener.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <span>
#include <utility>

#include "core/clock.h"
#include "core/error.h"

namespace fresco {
namespace {

// For a handler that is slower than the network for a moment; the kernel keeps what comes beyond, as long as
// its own buffer has room.
constexpr size_t kMaximumWaitingBytes = size_t{64} << 20;

template <class Value>
bool SetOption(int descriptor, int level, int name, const Value& value) {
  return setsockopt(descriptor, level, name, &value, sizeof(value)) == 0;
}

/// When the kernel received it, in microseconds since the epoch.
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

MulticastListener::MulticastListener()
    : socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)),
      slots_(kBatchDatagrams),
      headers_(kBatchDatagrams) {}

MulticastListener::MulticastListener(const MulticastEndpoint& endpoint) : MulticastListener() {
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
  // As LCM has it: several programs share the port, and the kernel may grant a smaller buffer.
  SetOption(socket_, SOL_SOCKET, SO_RCVBUF, endpoint.receive_buffer_bytes);
  SetOption(socket_, SOL_SOCKET, SO_TIMESTAMP, 1);
  expect(SetOption(socket_, SOL_SOCKET, SO_REUSEADDR, 1), "SO_REUSEADDR");
  expect(bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0, "bind");
  expect(SetOption(socket_, IPPROTO_IP, IP_ADD_MEMBERSHIP, membership), "IP_ADD_MEMBERSHIP");
}

MulticastListener::~MulticastListener() {
  close(socket_);
}

bool MulticastListener::Hears(const std::string& channel, const std::function<void()>& send) {
  constexpr int64_t kPatienceUs = 10'000'000;
  constexpr int kSendAgainMs = 100;
  const int64_t deadline_us = MonotonicMicroseconds() + kPatienceUs;
  int64_t send_at_us = MonotonicMicroseconds();
  while (MonotonicMicroseconds() < deadline_us) {
    if (MonotonicMicroseconds() >= send_at_us) {
      send();
      send_at_us = MonotonicMicroseconds() + 1000 * kSendAgainMs;
    }
    pollfd readable{socket_, POLLIN, 0};
    poll(&readable, 1, kSendAgainMs);
    Receive();
    const bool heard = std::any_of(waiting_.begin(), waiting_.end(), [&](const Waiting& waiting) {
      return waiting.message.channel == channel;
    });
    waiting_.clear();
    waiting_bytes_ = 0;
    if (heard) {
      return true;
    }
  }
  return false;
}

int MulticastListener::HandOut(const BusEventHandler& handler, int maximum) {
  if (waiting_bytes_ < kMaximumWaitingBytes) {
    Receive();
  }
  int count = 0;
  while (count < maximum && !waiting_.empty()) {
    const auto [utime, message] = std::move(waiting_.front());
    waiting_.pop_front();
    waiting_bytes_ -= message.content.size();
    ++count;
    handler({handed_out_++, utime, message.channel, message.content});
  }
  return count;
}

void MulticastListener::Receive() {
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
  for (int i = 0; i < received; ++i) {
    Take(static_cast<size_t>(i));
  }
}

void MulticastListener::Take(size_t index) {
  const Slot& slot = slots_[index];
  const int64_t utime = ReceiveTime(headers_[index].msg_hdr);
  const uint64_t sender = uint64_t{slot.sender.sin_addr.s_addr} << 16 | slot.sender.sin_port;
  const auto datagram = std::span(slot.datagram).first(headers_[index].msg_len);
  if (auto message = assembler_.Take(datagram, sender, utime)) {
    waiting_bytes_ += message->content.size();
    waiting_.push_back({utime, std::move(*message)});
  }
}

UnheardTraffic MulticastListener::unheard() const {
  return {assembler_.refused_datagrams(), assembler_.incomplete_messages()};
}

}  // namespace fresco
