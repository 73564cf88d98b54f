#include "logs/bus_losses.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

namespace fresco {
namespace {

/// Returns the inodes of this program's open sockets.
std::set<std::string> OwnSockets() {
  const std::string prefix = "socket:[";
  std::set<std::string> inodes;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", error)) {
    const std::string target = std::filesystem::read_symlink(entry.path(), error).string();
    if (target.starts_with(prefix)) {
      inodes.insert(target.substr(prefix.size(), target.size() - prefix.size() - 1));
    }
  }
  return inodes;
}

}  // namespace

int64_t DroppedDatagrams() {
  const std::set<std::string> sockets = OwnSockets();
  std::ifstream table("/proc/self/net/udp");
  std::string line;
  std::getline(table, line);  // skips the heading
  int64_t dropped = 0;
  while (std::getline(table, line)) {
    // sl local remote state queues timer retransmits uid timeout inode references pointer drops
    std::istringstream words(line);
    std::string skipped;
    std::string inode;
    int64_t drops = 0;
    for (int column = 0; column < 9; ++column) {
      words >> skipped;
    }
    if (words >> inode >> skipped >> skipped >> drops && sockets.contains(inode)) {
      dropped += drops;
    }
  }
  return dropped;
}

std::string BusLossText(const Bus& bus) {
  const UnheardTraffic unheard = bus.unheard();
  std::string text;
  const auto add = [&](int64_t count, const char* what) {
    text += count > 0 ? fmt::format(", {} {}", count, what) : "";
  };
  add(DroppedDatagrams(), "packets LOST");
  add(unheard.refused_packets, "packets REFUSED");
  add(unheard.incomplete_messages, "messages INCOMPLETE");
  return text;
}

void WarnOfBusLosses(const Bus& bus) {
  if (const int64_t lost = DroppedDatagrams(); lost > 0) {
    spdlog::warn(
        "{} packets were lost before this program saw them, since its receive buffer was full; raise "
        "recv_buf_size in the URL (the sysctl net.core.rmem_max limits it)",
        lost);
  }
  const UnheardTraffic unheard = bus.unheard();
  if (unheard.refused_packets > 0) {
    spdlog::warn("{} packets were refused: they are not LCM's, are damaged, or contradict others",
                 unheard.refused_packets);
  }
  if (unheard.incomplete_messages > 0) {
    spdlog::warn("{} messages of several packets are missing: not all of their packets arrived",
                 unheard.incomplete_messages);
  }
}

}  // namespace fresco
