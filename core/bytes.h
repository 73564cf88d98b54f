// Bytes as they are on the wire and in files: their checksum, and numbers in them. Pure functions; any thread
// may call them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace fresco {

/// CRC-32C (Castagnoli; RFC 3720, appendix B.4), which guards networks on the wire and files on disk.
/// `previous` is the CRC of the bytes before these (0 at the beginning), so Crc32c(b, Crc32c(a)) is the CRC
/// of a followed by b.
uint32_t Crc32c(std::span<const std::byte> bytes, uint32_t previous = 0);

/// The CRC of float values as they lie in memory (little-endian on every supported host).
uint32_t Crc32c(std::span<const float> values);

/// Reads a number as LCM writes it in messages, logs and packets: the unsigned number in the first
/// sizeof(Unsigned) bytes, most significant first.
template <class Unsigned>
Unsigned ReadBigEndian(const std::byte* bytes) {
  Unsigned value = 0;
  for (size_t i = 0; i < sizeof(Unsigned); ++i) {
    value = static_cast<Unsigned>(uint64_t{value} << 8 | std::to_integer<Unsigned>(bytes[i]));
  }
  return value;
}

}  // namespace fresco
