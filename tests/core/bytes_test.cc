// Against the published vectors of RFC 3720, appendix B.4, and the check value of the CRC catalogue.
#include "core/bytes.h"

#include <gtest/gtest.h>

#include <numeric>
#include <string_view>
#include <vector>

namespace fresco {
namespace {

std::vector<std::byte> Bytes(std::initializer_list<int> values) {
  std::vector<std::byte> bytes;
  for (const int value : values) {
    bytes.push_back(static_cast<std::byte>(value));
  }
  return bytes;
}

TEST(Crc32c, MatchesTheVectorsOfRfc3720) {
  EXPECT_EQ(Crc32c(std::vector<std::byte>(32, std::byte{0x00})), 0x8A9136AAu);
  EXPECT_EQ(Crc32c(std::vector<std::byte>(32, std::byte{0xFF})), 0x62A8AB43u);
  std::vector<std::byte> ascending(32);
  for (size_t i = 0; i < ascending.size(); ++i) {
    ascending[i] = static_cast<std::byte>(i);
  }
  EXPECT_EQ(Crc32c(ascending), 0x46DD794Eu);
  EXPECT_EQ(Crc32c(std::vector<std::byte>(ascending.rbegin(), ascending.rend())), 0x113FDB5Cu);
}

TEST(Crc32c, MatchesTheCheckValueOfTheCatalogue) {
  EXPECT_EQ(Crc32c(std::as_bytes(std::span(std::string_view("123456789")))), 0xE3069283u);
}

TEST(Crc32c, IsThatOfALoopOverBitsForEveryLength) {
  std::vector<std::byte> bytes;
  uint32_t remainder = ~0u;
  for (int length = 0; length < 100; ++length) {
    EXPECT_EQ(Crc32c(bytes), ~remainder) << length;
    bytes.push_back(static_cast<std::byte>(37 * length + 11));
    remainder ^= std::to_integer<uint32_t>(bytes.back());
    for (int bit = 0; bit < 8; ++bit) {
      remainder = (remainder >> 1) ^ ((remainder & 1) * 0x82F63B78u);
    }
  }
}

TEST(Crc32c, GoesOnWhereAnEarlierPartEnded) {
  const auto whole = Bytes({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13});
  for (size_t cut = 0; cut <= whole.size(); ++cut) {
    const std::span<const std::byte> all(whole);
    EXPECT_EQ(Crc32c(all.subspan(cut), Crc32c(all.first(cut))), Crc32c(all)) << cut;
  }
}

TEST(Crc32c, OfFloatsIsThatOfTheirLittleEndianBytes) {
  const std::vector<float> one = {1.0f};  // 0x3F800000
  EXPECT_EQ(Crc32c(std::span<const float>(one)), Crc32c(Bytes({0x00, 0x00, 0x80, 0x3F})));
}

}  // namespace
}  // namespace fresco
