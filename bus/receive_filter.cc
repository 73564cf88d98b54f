#include "bus/receive_filter.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <linux/filter.h>
#include <sys/socket.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>

#include "core/error.h"

namespace fresco {
namespace {

constexpr std::string_view kWholeMessage = "LC02";
constexpr uint32_t kUdpHeaderBytes = 8;  // a UDP socket's filter sees it, too
constexpr uint32_t kChannelAt = kUdpHeaderBytes + 8;
constexpr size_t kLongestChannel = 63;
constexpr uint32_t kAllBytes = 0xFFFFFFFF;

std::vector<int> OpenDescriptors() {
  std::vector<int> descriptors;
  std::error_code error;
  std::filesystem::directory_iterator entry("/proc/self/fd", error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename();
    int descriptor = -1;
    std::from_chars(name.data(), name.data() + name.size(), descriptor);
    descriptors.push_back(descriptor);
  }
  if (error) {
    throw Failure("can't look for LCM's socket in /proc/self/fd: " + error.message() + "; mount /proc");
  }
  return descriptors;
}

/// Of an IPv4 datagram socket.
std::optional<uint16_t> BoundPort(int descriptor) {
  int type = 0;
  socklen_t type_bytes = sizeof(type);
  sockaddr_in address{};
  socklen_t address_bytes = sizeof(address);
  if (getsockopt(descriptor, SOL_SOCKET, SO_TYPE, &type, &type_bytes) != 0 || type != SOCK_DGRAM ||
      getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &address_bytes) != 0 ||
      address.sin_family != AF_INET) {
    return std::nullopt;
  }
  return ntohs(address.sin_port);
}

using Instructions = std::vector<sock_filter>;

/// Goes on where these bytes stand `at` their place, else behind `skipped` further instructions. A datagram
/// that ends before them is dropped at the byte that it lacks; all before it are the same, so no other
/// channel's end fits.
void AddComparison(std::string_view bytes, uint32_t at, size_t skipped, Instructions& program) {
  for (size_t i = 0; i < bytes.size(); ++i) {
    const size_t rest = 2 * (bytes.size() - i - 1) + skipped;
    program.push_back(BPF_STMT(BPF_LD | BPF_B | BPF_ABS, at + static_cast<uint32_t>(i)));
    program.push_back(
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<uint8_t>(bytes[i]), 0, static_cast<uint8_t>(rest)));
  }
}

}  // namespace

std::vector<int> ReceivingSockets(uint16_t port) {
  std::vector<int> sockets;
  for (const int descriptor : OpenDescriptors()) {
    if (BoundPort(descriptor) == port) {
      sockets.push_back(descriptor);
    }
  }
  return sockets;
}

ReceiveFilter::ReceiveFilter(int socket) : socket_(socket) {
  Attach();
}

void ReceiveFilter::Pass(const std::string& channel) {
  if (channel.size() > kLongestChannel || channel.find('\0') != std::string::npos) {
    throw UsageError(fmt::format("LCM channel \"{}\": expected a name of up to {} bytes, found {}", channel,
                                 kLongestChannel, channel.size()));
  }
  channels_.push_back(channel);
  if (!passes_all_) {
    Attach();
  }
}

void ReceiveFilter::PassAll() {
  passes_all_ = true;
  Attach();
}

void ReceiveFilter::Attach() const {
  const sock_filter pass = BPF_STMT(BPF_RET | BPF_K, kAllBytes);
  const sock_filter drop = BPF_STMT(BPF_RET | BPF_K, 0);
  Instructions instructions;
  if (passes_all_) {
    instructions.push_back(pass);
  }
  for (const std::string& channel : channels_) {
    const std::string_view ended(channel.c_str(), channel.size() + 1);
    AddComparison(kWholeMessage, kUdpHeaderBytes, 2 * ended.size() + 1, instructions);
    AddComparison(ended, kChannelAt, 1, instructions);
    instructions.push_back(pass);
  }
  instructions.push_back(drop);
  const sock_fprog program = {static_cast<uint16_t>(instructions.size()), instructions.data()};
  if (setsockopt(socket_, SOL_SOCKET, SO_ATTACH_FILTER, &program, sizeof(program)) != 0) {
    throw Failure(
        fmt::format("can't filter what LCM receives on {} channels: expected a kernel that takes socket "
                    "filters (SO_ATTACH_FILTER), found: {}",
                    channels_.size(), std::strerror(errno)));
  }
}

}  // namespace fresco
