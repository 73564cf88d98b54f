// Splits a network's parameters into chunks that each fit one Ethernet frame, and checks chunks that arrive.
// Pure functions; any thread may call them.
#pragma once

#include <cstdint>
#include <span>

#include "msgs/order.h"
#include "msgs/wire.h"

namespace fresco {

/// The number of chunks of a network with `parameters` (>= 1) values.
int ChunkCount(int64_t parameters);

/// Returns chunk number `chunk`, 0 .. ChunkCount - 1, of a version. `values` are all its parameters, `crc32c`
/// is their CRC-32C. The caller fills in `utime`, `run_id` and `config_hash`.
weights_t WeightsChunk(std::span<const float> values, uint32_t crc32c, int32_t version, int chunk);

/// Returns the number of the chunk that the message holds, or -1 if its offset and counts are not those of
/// any chunk of a network with `parameters` values.
int ChunkIndex(const weights_t& message, int64_t parameters);

}  // namespace fresco
