// Philox against the known-answer vectors of Random123 (kat_vectors, philox4x32, 10 rounds).
#include "core/random.h"

#include <gtest/gtest.h>

#include <map>
#include <vector>

namespace fresco {
namespace {

using Block = std::array<uint32_t, 4>;

TEST(Philox, MatchesTheKnownAnswersOfRandom123) {
  EXPECT_EQ(Philox4x32({0, 0, 0, 0}, {0, 0}), (Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(Philox4x32({~0u, ~0u, ~0u, ~0u}, {~0u, ~0u}),
            (Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(Philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(RandomStream, IsTheSequenceOfPhiloxBlocksOfItsKey) {
  RandomStream stream(0x0000000200000001u, RandomPurpose::kTest, 7, 9);
  for (uint32_t block = 0; block < 3; ++block) {
    for (const uint32_t word :
         Philox4x32({block, 9, 7, static_cast<uint32_t>(RandomPurpose::kTest)}, {1, 2})) {
      EXPECT_EQ(stream.NextWord(), word);
    }
  }
}

TEST(RandomStream, DiffersWhereAnyPartOfItsKeyDiffers) {
  const auto first = [](uint64_t seed, RandomPurpose purpose, uint32_t a, uint32_t b) {
    return RandomStream(seed, purpose, a, b).NextWord();
  };
  const uint32_t word = first(1, RandomPurpose::kTest, 2, 3);
  EXPECT_EQ(word, first(1, RandomPurpose::kTest, 2, 3));
  EXPECT_NE(word, first(2, RandomPurpose::kTest, 2, 3));
  EXPECT_NE(word, first(1, RandomPurpose::kActing, 2, 3));
  EXPECT_NE(word, first(1, RandomPurpose::kTest, 3, 3));
  EXPECT_NE(word, first(1, RandomPurpose::kTest, 2, 4));
  EXPECT_NE(word, first(1ull << 32 | 1, RandomPurpose::kTest, 2, 3));
}

TEST(RandomStream, UniformIsInTheHalfOpenUnitIntervalWithMeanOneHalf) {
  RandomStream stream(5, RandomPurpose::kTest, 0, 0);
  constexpr int kDraws = 100000;
  double sum = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double uniform = stream.NextUniform();
    ASSERT_GE(uniform, 0.0);
    ASSERT_LT(uniform, 1.0);
    sum += uniform;
  }
  EXPECT_NEAR(sum / kDraws, 0.5, 0.005);  // five standard errors
}

TEST(RandomStream, BelowHitsEveryValueEquallyOften) {
  RandomStream stream(6, RandomPurpose::kTest, 0, 0);
  std::map<uint32_t, int> counts;
  constexpr int kDraws = 70000;
  for (int i = 0; i < kDraws; ++i) {
    ++counts[stream.NextBelow(7)];
  }
  ASSERT_EQ(counts.size(), 7u);
  for (const auto& [value, count] : counts) {
    EXPECT_LT(value, 7u);
    EXPECT_NEAR(count, kDraws / 7, 500) << value;  // five standard deviations
  }
  EXPECT_EQ(stream.NextBelow(1), 0u);
}

}  // namespace
}  // namespace fresco
