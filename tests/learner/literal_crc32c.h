// CRC-32C bit by bit, as RFC 3720 defines it: what files and messages are held against.
#pragma once

#include <bit>
#include <cstdint>

#include "nn/mlp.h"

namespace fresco {

/// Of the values as little-endian floats.
inline uint32_t LiteralCrc32c(const Vector& values) {
  uint32_t crc = 0xffffffffu;
  for (const float value : values) {
    const auto word = std::bit_cast<uint32_t>(value);
    for (int bit = 0; bit < 32; ++bit) {  // the lowest bit of the lowest byte first
      const uint32_t feedback = (crc ^ (word >> bit)) & 1;
      crc = (crc >> 1) ^ (feedback * 0x82f63b78u);
    }
  }
  return ~crc;
}

}  // namespace fresco
