// Names the versions of the networks, splits their parameters into chunks that each fit one Ethernet frame,
// and checks chunks that arrive. Pure functions; any thread may call them.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <span>

#include "msgs/order.h"
#include "msgs/wire.h"

namespace fresco {

/// One version of one of the two networks.
struct NetworkVersion {
  NetworkKind kind = NetworkKind::kCurrent;
  int32_t number = 0;  ///< 0, 1, .. for each network
  auto operator<=>(const NetworkVersion&) const = default;
};

/// "current" or "target".
const char* Name(NetworkKind kind);

/// The versions that an order names: the one of the current network, then the one of the target network.
std::array<NetworkVersion, 2> VersionsOf(const Order& order);

/// The message for `count` chunks of a version, from chunk `first` on.
chunk_range_t ChunkRange(NetworkVersion version, int first, int count);
/// The version that the chunks of the message belong to. It may be one that does not exist.
NetworkVersion VersionOf(const chunk_range_t& range);

/// The number of chunks of a network with `parameters` (>= 1) values.
int ChunkCount(int64_t parameters);

/// Returns chunk number `chunk`, 0 .. ChunkCount - 1, of a version. `values` are all its parameters, `crc32c`
/// is their CRC-32C. The caller fills in `utime`, `run_id` and `config_hash`.
weights_t WeightsChunk(std::span<const float> values, uint32_t crc32c, int32_t version, int chunk);

/// Returns the number of the chunk that the message holds, or -1 if its offset and counts are not those of
/// any chunk of a network with `parameters` values.
int ChunkIndex(const weights_t& message, int64_t parameters);

}  // namespace fresco
