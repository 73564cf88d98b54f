#include "core/bytes.h"

#include <array>
#include <bit>
#include <cstring>

#if defined(__x86_64__)
#include <nmmintrin.h>
#endif

namespace fresco {
namespace {

static_assert(std::endian::native == std::endian::little, "checksums and files assume little-endian hosts");

constexpr uint32_t kReflectedPolynomial = 0x82F63B78u;

// Entry [n][byte] is what a byte that n bytes follow contributes to the remainder.
using Tables = std::array<std::array<uint32_t, 256>, 8>;

constexpr Tables MakeTables() {
  Tables tables{};
  for (uint32_t byte = 0; byte < 256; ++byte) {
    uint32_t remainder = byte;
    for (int bit = 0; bit < 8; ++bit) {
      remainder = (remainder >> 1) ^ ((remainder & 1u) != 0 ? kReflectedPolynomial : 0u);
    }
    tables[0][byte] = remainder;
  }
  for (size_t following = 1; following < tables.size(); ++following) {
    for (size_t byte = 0; byte < 256; ++byte) {
      const uint32_t nearer = tables[following - 1][byte];
      tables[following][byte] = (nearer >> 8) ^ tables[0][nearer & 0xFFu];
    }
  }
  return tables;
}

constexpr Tables kTables = MakeTables();

/// Adds the bytes to a remainder. Any processor can do this.
uint32_t AddByTables(std::span<const std::byte> bytes, uint32_t crc) {
  size_t i = 0;
  for (; i + kTables.size() <= bytes.size(); i += kTables.size()) {
    uint64_t word = 0;
    std::memcpy(&word, bytes.data() + i, sizeof word);
    word ^= crc;
    crc = 0;
    for (size_t byte = 0; byte < kTables.size(); ++byte) {
      crc ^= kTables[kTables.size() - 1 - byte][word >> (8 * byte) & 0xFFu];
    }
  }
  for (; i < bytes.size(); ++i) {
    crc = (crc >> 8) ^ kTables[0][(crc ^ static_cast<uint32_t>(bytes[i])) & 0xFFu];
  }
  return crc;
}

#if defined(__x86_64__)
/// The same by the instruction of x86-64-v2, which is several times as fast.
__attribute__((target("sse4.2"))) uint32_t AddByInstruction(std::span<const std::byte> bytes, uint32_t crc) {
  constexpr size_t kWord = sizeof(uint64_t);
  uint64_t remainder = crc;
  size_t i = 0;
  for (; i + kWord <= bytes.size(); i += kWord) {
    uint64_t word = 0;
    std::memcpy(&word, bytes.data() + i, kWord);
    remainder = _mm_crc32_u64(remainder, word);
  }
  crc = static_cast<uint32_t>(remainder);
  for (; i < bytes.size(); ++i) {
    crc = _mm_crc32_u8(crc, std::to_integer<uint8_t>(bytes[i]));
  }
  return crc;
}
#endif

using AddFunction = uint32_t (*)(std::span<const std::byte>, uint32_t);

/// The fastest of these on this processor.
AddFunction FastestAdd() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("sse4.2")) {
    return AddByInstruction;
  }
#endif
  return AddByTables;
}

}  // namespace

uint32_t Crc32c(std::span<const std::byte> bytes, uint32_t previous) {
  static const AddFunction add = FastestAdd();
  return ~add(bytes, ~previous);
}

uint32_t Crc32c(std::span<const float> values) {
  return Crc32c(std::as_bytes(values));
}

}  // namespace fresco
