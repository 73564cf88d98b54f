#include "core/random.h"

#include "core/error.h"

namespace fresco {

std::array<uint32_t, 4> Philox4x32(std::array<uint32_t, 4> counter, std::array<uint32_t, 2> key) {
  constexpr uint64_t kMultiplier0 = 0xD2511F53u;
  constexpr uint64_t kMultiplier1 = 0xCD9E8D57u;
  constexpr uint32_t kWeyl0 = 0x9E3779B9u;
  constexpr uint32_t kWeyl1 = 0xBB67AE85u;
  constexpr int kRounds = 10;
  for (int round = 0; round < kRounds; ++round) {
    const uint64_t product0 = kMultiplier0 * counter[0];
    const uint64_t product1 = kMultiplier1 * counter[2];
    counter = {static_cast<uint32_t>(product1 >> 32) ^ counter[1] ^ key[0], static_cast<uint32_t>(product1),
               static_cast<uint32_t>(product0 >> 32) ^ counter[3] ^ key[1], static_cast<uint32_t>(product0)};
    key[0] += kWeyl0;
    key[1] += kWeyl1;
  }
  return counter;
}

RandomStream::RandomStream(uint64_t seed, RandomPurpose purpose, uint32_t first_index, uint32_t second_index)
    : key_{static_cast<uint32_t>(seed), static_cast<uint32_t>(seed >> 32)},
      counter_{0, second_index, first_index, static_cast<uint32_t>(purpose)} {}

uint32_t RandomStream::NextWord() {
  if (used_ == 4) {
    block_ = Philox4x32(counter_, key_);
    ++counter_[0];
    used_ = 0;
  }
  return block_[static_cast<std::size_t>(used_++)];
}

double RandomStream::NextUniform() {
  const uint64_t high = NextWord();
  const uint64_t low = NextWord();
  return static_cast<double>(((high << 32) | low) >> 11) * 0x1.0p-53;
}

uint32_t RandomStream::NextBelow(uint32_t bound) {
  FRESCO_CHECK(bound >= 1);
  // Lemire, "Fast random integer generation in an interval", 2019: multiply, reject the biased part.
  uint64_t product = static_cast<uint64_t>(NextWord()) * bound;
  if (static_cast<uint32_t>(product) < bound) {  // else there is no need for the slow division
    const uint32_t threshold = (0u - bound) % bound;
    while (static_cast<uint32_t>(product) < threshold) {
      product = static_cast<uint64_t>(NextWord()) * bound;
    }
  }
  return static_cast<uint32_t>(product >> 32);
}

}  // namespace fresco
