#include "bus/receive_filter.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <linux/filter.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <optional>
#include <span>
#include <system_error>

#include "bus/message_assembler.h"
#include "core/bytes.h"
#include "core/error.h"

namespace fresco {
namespace {

constexpr uint32_t kUdpHeaderBytes = 8;  // the filter of a UDP socket sees the UDP header, too
constexpr uint32_t kChannelAt = kUdpHeaderBytes + kWholeMessageHeaderBytes;
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

/// The local port, if this is an IPv4 datagram socket.
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

std::vector<int> SocketsOnPort(uint16_t port) {
  std::vector<int> sockets;
  for (const int descriptor : OpenDescriptors()) {
    if (BoundPort(descriptor) == port) {
      sockets.push_back(descriptor);
    }
  }
  return sockets;
}

using Instructions = std::vector<sock_filter>;

/// An instruction that loads some bytes, and the value that these must have.
struct Load {
  uint16_t size_code;
  uint32_t bytes;
  uint32_t expected;
};

Load LargestLoad(std::span<const std::byte> of) {
  if (of.size() >= sizeof(uint32_t)) {
    return {BPF_W, sizeof(uint32_t), ReadBigEndian<uint32_t>(of.data())};
  }
  if (of.size() >= sizeof(uint16_t)) {
    return {BPF_H, sizeof(uint16_t), ReadBigEndian<uint16_t>(of.data())};
  }
  return {BPF_B, sizeof(uint8_t), ReadBigEndian<uint8_t>(of.data())};
}

/// Appends instructions that let the datagram pass if it is on this channel, and otherwise continue behind
/// them. Uses as few loads as possible, since the kernel turns each into a dozen instructions and has little
/// memory for them (net.core.optmem_max).
void AddChannel(const std::string& channel, Instructions& program) {
  const auto ended = std::as_bytes(std::span(channel.c_str(), channel.size() + 1));
  Instructions block;
  block.push_back(BPF_STMT(BPF_LD | BPF_W | BPF_LEN, 0));  // checked first: a load beyond the end drops the
                                                           // datagram
  block.push_back(
      BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, kChannelAt + static_cast<uint32_t>(ended.size()), 0, 0));
  for (uint32_t i = 0; i < ended.size();) {
    const Load load = LargestLoad(ended.subspan(i));
    block.push_back(BPF_STMT(static_cast<uint16_t>(BPF_LD | load.size_code | BPF_ABS), kChannelAt + i));
    block.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, load.expected, 0, 0));
    i += load.bytes;
  }
  block.push_back(BPF_STMT(BPF_RET | BPF_K, kAllBytes));
  // If a comparison fails, jump behind the block. That is near enough: 64 bytes make 35 instructions, and a
  // jump reaches 255.
  for (size_t i = 0; i < block.size(); ++i) {
    if (BPF_CLASS(block[i].code) == BPF_JMP) {
      block[i].jf = static_cast<uint8_t>(block.size() - i - 1);
    }
  }
  program.insert(program.end(), block.begin(), block.end());
}

}  // namespace

std::mutex& ReceivingSockets() {
  static std::mutex sockets;
  return sockets;
}

int SocketOpenedBy(const std::function<void()>& open, uint16_t port) {
  const std::vector<int> before = SocketsOnPort(port);
  open();
  std::vector<int> opened = SocketsOnPort(port);
  std::erase_if(opened,
                [&](int socket) { return std::find(before.begin(), before.end(), socket) != before.end(); });
  if (opened.size() != 1) {
    throw Failure(
        fmt::format("expected one new socket on UDP port {}, LCM's own, found {}", port, opened.size()));
  }
  return opened.front();
}

ReceiveFilter::ReceiveFilter(int socket) : socket_(socket) {
  Attach();
}

void ReceiveFilter::Pass(const std::string& channel) {
  channels_.push_back(channel);
  Attach();
}

void ReceiveFilter::Attach() const {
  const sock_filter drop = BPF_STMT(BPF_RET | BPF_K, 0);
  Instructions instructions = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kUdpHeaderBytes),  // drops datagrams that are too short for this
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kWholeMessageMagic, 1, 0), drop};
  for (const std::string& channel : channels_) {
    AddChannel(channel, instructions);
  }
  instructions.push_back(drop);
  const sock_fprog program = {static_cast<uint16_t>(instructions.size()), instructions.data()};
  if (setsockopt(socket_, SOL_SOCKET, SO_ATTACH_FILTER, &program, sizeof(program)) != 0) {
    throw Failure(fmt::format(
        "can't attach a filter for {} channels to LCM's socket: expected a kernel that takes socket filters "
        "of {} instructions (SO_ATTACH_FILTER), found: {}{}",
        channels_.size(), instructions.size(), std::strerror(errno),
        errno == ENOMEM ? "; raise it with: sysctl net.core.optmem_max=131072" : ""));
  }
}

}  // namespace fresco
