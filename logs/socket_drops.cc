#include "logs/socket_drops.h"

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

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

}  // namespace fresco
