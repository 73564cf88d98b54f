// CRC-32C (Castagnoli; RFC 3720, appendix B.4): guards networks on the wire and files on disk.
// Pure and thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace fresco {

/// CRC-32C of `bytes`; `previous` is the CRC of the bytes before them (0 at the beginning), so
/// Crc32c(b, Crc32c(a)) is the CRC of a followed by b.
uint32_t Crc32c(std::span<const std::byte> bytes, uint32_t previous = 0);

/// The CRC of float values as they lie in memory (little-endian on every supported host).
uint32_t Crc32c(std::span<const float> values);

}  // namespace fresco
