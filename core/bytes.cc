#include "core/bytes.h"

#include <array>
#include <bit>
#include <cstring>

namespace fresco {
namespace {

static_assert(std::endian::native == std::endian::little, "checksums and files assume little-endian hosts");

constexpr uint32_t kReflectedPolynomial = 0x82F63B78u;

constexpr std::array<uint32_t, 256> MakeTable() {
  std::array<uint32_t, 256> table{};
  for (uint32_t byte = 0; byte < 256; ++byte) {
    uint32_t remainder = byte;
    for (int bit = 0; bit < 8; ++bit) {
      remainder = (remainder >> 1) ^ ((remainder & 1u) != 0 ? kReflectedPolynomial : 0u);
    }
    table[byte] = remainder;
  }
  return table;
}

constexpr std::array<uint32_t, 256> kTable = MakeTable();

}  // namespace

uint32_t Crc32c(std::span<const std::byte> bytes, uint32_t previous) {
  uint32_t crc = ~previous;
  size_t i = 0;
#ifdef __SSE4_2__
  for (; i + sizeof(uint64_t) <= bytes.size(); i += sizeof(uint64_t)) {
    uint64_t word;
    std::memcpy(&word, bytes.data() + i, sizeof word);
    crc = static_cast<uint32_t>(__builtin_ia32_crc32di(crc, word));
  }
#endif
  for (; i < bytes.size(); ++i) {
    crc = (crc >> 8) ^ kTable[(crc ^ static_cast<uint32_t>(bytes[i])) & 0xFFu];
  }
  return ~crc;
}

uint32_t Crc32c(std::span<const float> values) {
  return Crc32c(std::as_bytes(values));
}

}  // namespace fresco
