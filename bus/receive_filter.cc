#include "bus/receive_filter.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <linux/filter.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "core/error.h"

namespace fresco {
namespace {

constexpr uint32_t kWholeMessage = 0x4C433032;  // "LC02"
constexpr uint32_t kUdpHeaderBytes = 8;         // a UDP socket's filter sees it, too
constexpr uint32_t kAllBytes = 0xFFFFFFFF;

std::vector<int> OpenDescriptors() {
  std::vector<int> descriptors;
  std::error_code error;  // without /proc: none
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", error)) {
    const std::string name = entry.path().filename();
    int descriptor = -1;
    std::from_chars(name.data(), name.data() + name.size(), descriptor);
    descriptors.push_back(descriptor);
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

void Attach(int descriptor) {
  std::array<sock_filter, 4> instructions = {{
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kUdpHeaderBytes),  // shorter datagrams end here, dropped
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kWholeMessage, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, kAllBytes),
      BPF_STMT(BPF_RET | BPF_K, 0),
  }};
  const sock_fprog program = {static_cast<uint16_t>(instructions.size()), instructions.data()};
  if (setsockopt(descriptor, SOL_SOCKET, SO_ATTACH_FILTER, &program, sizeof(program)) != 0) {
    throw Failure(
        fmt::format("can't keep fragments from LCM's socket: expected a kernel that takes socket filters "
                    "(SO_ATTACH_FILTER), found: {}",
                    std::strerror(errno)));
  }
}

}  // namespace

void DropFragments(uint16_t port) {
  bool found = false;
  for (const int descriptor : OpenDescriptors()) {
    if (BoundPort(descriptor) == port) {
      Attach(descriptor);
      found = true;
    }
  }
  if (!found) {
    throw Failure(
        fmt::format("can't keep fragments from LCM: expected its socket, on UDP port {}, among those in "
                    "/proc/self/fd, found none; is /proc mounted?",
                    port));
  }
}

}  // namespace fresco
