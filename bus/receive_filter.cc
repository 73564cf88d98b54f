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

#include "bus/lcm_datagram.h"
#include "core/big_endian.h"
#include "core/error.h"

namespace fresco {
namespace {

constexpr uint32_t kUdpHeaderBytes = 8;  // a UDP socket's filter sees it, too
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

/// A load, and what it has to load.
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

/// Ends the program with everything passing where the channel, with its end, stands at its place; goes on
/// behind where it does not. Few loads: the kernel makes a dozen instructions of each and has little room
/// (net.core.optmem_max).
void AddChannel(const std::string& channel, Instructions& program) {
  const auto ended = std::as_bytes(std::span(channel.c_str(), channel.size() + 1));
  Instructions block;
  block.push_back(BPF_STMT(BPF_LD | BPF_W | BPF_LEN, 0));  // a load behind the datagram's end would drop it
  block.push_back(
      BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, kChannelAt + static_cast<uint32_t>(ended.size()), 0, 0));
  for (uint32_t i = 0; i < ended.size();) {
    const Load load = LargestLoad(ended.subspan(i));
    block.push_back(BPF_STMT(static_cast<uint16_t>(BPF_LD | load.size_code | BPF_ABS), kChannelAt + i));
    block.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, load.expected, 0, 0));
    i += load.bytes;
  }
  block.push_back(BPF_STMT(BPF_RET | BPF_K, kAllBytes));
  // Where a comparison fails, on behind the block: 64 bytes make 35 instructions, a jump's reach is 255.
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
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kUdpHeaderBytes),  // shorter ones end here, dropped
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kWholeMessageMagic, 1, 0), drop};
  for (const std::string& channel : channels_) {
    AddChannel(channel, instructions);
  }
  instructions.push_back(drop);
  const sock_fprog program = {static_cast<uint16_t>(instructions.size()), instructions.data()};
  if (setsockopt(socket_, SOL_SOCKET, SO_ATTACH_FILTER, &program, sizeof(program)) != 0) {
    throw Failure(fmt::format(
        "can't filter what LCM receives, {} channels: expected a kernel that takes socket filters "
        "of {} instructions (SO_ATTACH_FILTER), found: {}{}",
        channels_.size(), instructions.size(), std::strerror(errno),
        errno == ENOMEM ? "; raise it with: sysctl net.core.optmem_max=131072" : ""));
  }
}

}  // namespace fresco
