// Networks as chunks that each fit one Ethernet frame, and back. Pure.
#pragma once

#include <cstdint>
#include <span>

#include "msgs/order.h"
#include "msgs/wire.h"

namespace fresco {

/// Chunks of a version of `parameters` values.
int ChunkCount(int64_t parameters);

/// Chunk `chunk` of a version, without its identity.
weights_t WeightsChunk(std::span<const float> values, uint32_t crc32c, int32_t version, int chunk);

/// Which chunk the message is, or -1 where offset and count are not those of a chunk of a network
/// of `parameters` values.
int ChunkIndex(const weights_t& message, int64_t parameters);

}  // namespace fresco
