#include "bus/multicast_socket.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/clock.h"
#include "core/error.h"

namespace fresco {
namespace {

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

MulticastSocket::MulticastSocket()
    : socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)),
      slots_(kBatchDatagrams),
      headers_(kBatchDatagrams) {}

MulticastSocket::MulticastSocket(const MulticastEndpoint& endpoint) : MulticastSocket() {
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

MulticastSocket::~MulticastSocket() {
  close(socket_);
}

void MulticastSocket::Receive(const std::function<void(const ReceivedDatagram&)>& take) {
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

}  // namespace fresco
