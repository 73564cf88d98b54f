#include "msgs/weights_codec.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <numeric>
#include <vector>

#include "tests/msgs/message_samples.h"

namespace fresco {
namespace {

std::vector<float> CountingValues(int64_t parameters) {
  std::vector<float> values(static_cast<size_t>(parameters));
  std::iota(values.begin(), values.end(), 1.0f);
  return values;
}

class WeightsCodec : public testing::TestWithParam<int64_t> {};

TEST_P(WeightsCodec, ChunksCoverTheVectorExactly) {
  const std::vector<float> values = CountingValues(GetParam());
  std::vector<float> joined(values.size(), 0.0f);
  for (int chunk = 0; chunk < ChunkCount(GetParam()); ++chunk) {
    weights_t message{};
    ASSERT_TRUE(Decode(Encoded(WeightsChunk(values, 0xfedcba98u, 17, chunk)), message));
    EXPECT_EQ(ChunkIndex(message, GetParam()), chunk);
    EXPECT_EQ(message.version, 17);
    EXPECT_EQ(message.crc32c, 0xfedcba98);
    EXPECT_EQ(message.total_values, GetParam());
    for (size_t i = 0; i < message.values.size(); ++i) {
      float& place = joined.at(static_cast<size_t>(message.offset) + i);
      EXPECT_EQ(place, 0.0f) << "covered twice";
      place = message.values[i];
    }
  }
  EXPECT_EQ(joined, values);
}

INSTANTIATE_TEST_SUITE_P(Sizes, WeightsCodec,
                         testing::Values(1, 307, 308, 309, 616, 1000, 58'196, 1'000'001));

class ChunkIndexOf : public testing::Test {
 protected:
  static constexpr int64_t kParameters = 1000;  // chunks of 308, 308, 308, 76

  template <class Change>
  int After(int chunk, Change change) const {
    weights_t message = WeightsChunk(values_, 1, 2, chunk);
    change(message);
    return ChunkIndex(message, kParameters);
  }

 private:
  const std::vector<float> values_ = CountingValues(kParameters);
};

TEST_F(ChunkIndexOf, TakesTheChunksOfTheNetwork) {
  for (int chunk = 0; chunk < 4; ++chunk) {
    EXPECT_EQ(After(chunk, [](weights_t&) {}), chunk);
  }
}

TEST_F(ChunkIndexOf, RefusesAnotherNetworksSize) {
  EXPECT_EQ(After(0, [](weights_t& message) { message.total_values = 999; }), -1);
  EXPECT_EQ(After(0, [](weights_t& message) { message.total_values = -1000; }), -1);
}

TEST_F(ChunkIndexOf, RefusesOffsetsThatNoChunkHas) {
  for (const int32_t offset : {-308, -1, 1, 307, 1000, 1232, std::numeric_limits<int32_t>::max(),
                               std::numeric_limits<int32_t>::min()}) {
    EXPECT_EQ(After(0, [&](weights_t& message) { message.offset = offset; }), -1) << offset;
  }
}

TEST_F(ChunkIndexOf, RefusesCountsThatContradictTheOffset) {
  for (const int32_t count : {-1, 0, 1, 76, 307}) {
    EXPECT_EQ(After(0, [&](weights_t& message) { message.value_count = count; }), -1) << count;
  }
  for (const int32_t count : {0, 75, 77, 308}) {
    EXPECT_EQ(After(3, [&](weights_t& message) { message.value_count = count; }), -1) << count;
  }
}

TEST_F(ChunkIndexOf, RefusesNegativeVersions) {
  EXPECT_EQ(After(0, [](weights_t& message) { message.version = -1; }), -1);
}

TEST(NetworkVersion, IsTheSameInARangeOfItsChunks) {
  Order order;
  order.current_version = 7;
  order.target_version = 3;
  const auto [current, target] = VersionsOf(order);
  EXPECT_EQ(current, (NetworkVersion{NetworkKind::kCurrent, 7}));
  EXPECT_EQ(target, (NetworkVersion{NetworkKind::kTarget, 3}));
  for (const NetworkVersion& version : {current, target}) {
    const chunk_range_t range = ChunkRange(version, 4, 2);
    EXPECT_EQ(VersionOf(range), version);
    EXPECT_EQ(range.first, 4);
    EXPECT_EQ(range.count, 2);
  }
  EXPECT_STREQ(Name(current.kind), "current");
  EXPECT_STREQ(Name(target.kind), "target");
}

}  // namespace
}  // namespace fresco
