// Converts the policies that a run produces to network files (best.network, final.network) and back. Reading
// refuses damaged and foreign files and those of a newer version. Any thread may call these functions.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "msgs/experiment.h"
#include "nn/network.h"

namespace fresco {

/// A version of the current network and the experiment that it was trained for.
struct StoredNetwork {
  Experiment experiment;
  int64_t version = 0;  ///< its number
  int64_t updates = 0;  ///< updates made when the version was made
  Vector parameters;    ///< as many as experiment.network() has
};

/// Returns the bytes of a network file.
std::string SerializeNetworkFile(const StoredNetwork& network);

/// Parses the bytes of a network file. Throws UsageError that names `origin` (the file) and what is wrong: it
/// is not a network file, is cut short, has a wrong CRC, or has sizes that contradict its configuration.
StoredNetwork ParseNetworkFile(std::string_view content, const std::string& origin);
/// Does the same with the content of a file. Also throws UsageError if the file can't be read.
StoredNetwork ReadNetworkFile(const std::filesystem::path& path);

}  // namespace fresco
