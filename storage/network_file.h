// A network on disk: the policy that a run delivers. Reading refuses torn, foreign and newer files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "msgs/experiment.h"
#include "nn/mlp.h"

namespace fresco {

/// A version of the current network with the experiment that it was trained for.
struct StoredNetwork {
  Experiment experiment;
  int64_t version = 0;
  int64_t updates = 0;
  Vector parameters;
};

/// The bytes of a network's file.
std::string SerializeNetworkFile(const StoredNetwork& network);

/// Written atomically; throws Failure where the disk does not take it.
void WriteNetworkFile(const std::filesystem::path& path, const StoredNetwork& network);

/// Throws UsageError naming `origin` (the file) and what is wrong: not a network file, truncated, a CRC
/// that does not hold, sizes that contradict the configuration.
StoredNetwork ParseNetworkFile(std::string_view content, const std::string& origin);
StoredNetwork ReadNetworkFile(const std::filesystem::path& path);

}  // namespace fresco
