#include "learner/weight_publisher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "core/bytes.h"
#include "core/random.h"
#include "tests/nn/literal_network.h"

namespace fresco {
namespace {

// Versions of 1,000 values in four chunks.
constexpr int kValues = 1000;  // 308 + 308 + 308 + 76
constexpr int kChunks = 4;
constexpr int64_t kNowUs = 1'000'000;
constexpr int32_t kIntMax = std::numeric_limits<int32_t>::max();
constexpr int32_t kIntMin = std::numeric_limits<int32_t>::min();

using Sent = std::vector<std::tuple<NetworkKind, int32_t, int>>;  // which network, version, chunk

std::shared_ptr<const Vector> ParametersOf(uint32_t version, int values = kValues) {
  RandomStream stream(1, RandomPurpose::kTest, version, 0);
  Vector parameters(values);
  for (float& value : parameters) {
    value = static_cast<float>(stream.NextUniform() - 0.5);
  }
  return std::make_shared<const Vector>(parameters);
}

/// Everything that is due at `now_us`.
Sent Drain(WeightPublisher& publisher, int64_t now_us) {
  Sent sent;
  constexpr size_t kEndless = 1000;
  while (const auto next = sent.size() < kEndless ? publisher.Next(now_us) : std::nullopt) {
    sent.emplace_back(next->first, next->second.version, ChunkIndex(next->second, kValues));
  }
  return sent;
}

/// The same by chunk: the order of what is sent again is free.
Sent DrainSorted(WeightPublisher& publisher, int64_t now_us) {
  Sent sent = Drain(publisher, now_us);
  std::sort(sent.begin(), sent.end());
  return sent;
}

Sent ChunksOf(NetworkKind kind, int32_t version, int first = 0, int end = kChunks) {
  Sent chunks;
  for (int chunk = first; chunk < end; ++chunk) {
    chunks.emplace_back(kind, version, chunk);
  }
  return chunks;
}

chunk_range_t Range(NetworkKind kind, int32_t version, int32_t first, int32_t count) {
  return ChunkRange({kind, version}, first, count);
}

/// All chunks of a version of the current network.
chunk_range_t AllOf(int32_t version) {
  return Range(NetworkKind::kCurrent, version, 0, kChunks);
}

TEST(WeightPublisher, SendsEachChunkOfANewVersionOnceInOrder) {
  WeightPublisher publisher;
  EXPECT_FALSE(publisher.Next(kNowUs));
  publisher.Offer({NetworkKind::kCurrent, 7}, ParametersOf(7));
  EXPECT_EQ(Drain(publisher, kNowUs), ChunksOf(NetworkKind::kCurrent, 7));
  EXPECT_FALSE(publisher.Next(kNowUs + 10'000'000));
  EXPECT_EQ(publisher.sent_chunks(), kChunks);
  EXPECT_EQ(publisher.repeated_chunks(), 0);
}

TEST(WeightPublisher, SendsChunksThatMakeUpTheParametersWithTheirCrc) {
  for (const int values : {1, 307, 308, 309, 616, 1000}) {
    const auto parameters = ParametersOf(3, values);
    const uint32_t crc = Crc32c(Values(*parameters));
    WeightPublisher publisher;
    publisher.Offer({NetworkKind::kTarget, 3}, parameters);
    std::vector<float> joined;
    while (const auto next = publisher.Next(kNowUs)) {
      const auto& [kind, chunk] = *next;
      EXPECT_EQ(kind, NetworkKind::kTarget);
      EXPECT_EQ(chunk.offset, static_cast<int32_t>(joined.size()));
      EXPECT_EQ(chunk.total_values, values);
      EXPECT_EQ(chunk.crc32c, int64_t{crc});
      EXPECT_EQ(chunk.value_count, static_cast<int32_t>(chunk.values.size()));
      joined.insert(joined.end(), chunk.values.begin(), chunk.values.end());
    }
    EXPECT_EQ(joined, std::vector<float>(parameters->begin(), parameters->end()));
  }
}

TEST(WeightPublisher, SendsOlderVersionsFirst) {
  WeightPublisher publisher;
  publisher.Offer({NetworkKind::kCurrent, 9}, ParametersOf(9));
  publisher.Offer({NetworkKind::kCurrent, 8}, ParametersOf(8));
  EXPECT_EQ(std::get<1>(Drain(publisher, kNowUs).front()), 8);
  publisher.Request(Range(NetworkKind::kCurrent, 9, 0, 1), kNowUs + 10'000);
  publisher.Request(Range(NetworkKind::kCurrent, 8, 3, 1), kNowUs + 10'000);
  EXPECT_EQ(Drain(publisher, kNowUs + 10'000),
            (Sent{{NetworkKind::kCurrent, 8, 3}, {NetworkKind::kCurrent, 9, 0}}));
}

TEST(WeightPublisher, DoesNotAnswerWithWhatMayStillBeOnItsWay) {
  WeightPublisher publisher;
  publisher.Offer({NetworkKind::kCurrent, 1}, ParametersOf(1));
  publisher.Next(kNowUs);
  publisher.Next(kNowUs + 1000);
  publisher.Request(AllOf(1), kNowUs + 6'999);  // chunk 0 was sent 7 ms ago, chunk 1 less than 6 ms
  EXPECT_EQ(Drain(publisher, kNowUs + 6'999).size(), 3u);  // 0, and 2 and 3 for the first time
  EXPECT_EQ(publisher.repeated_chunks(), 1);
  publisher.Request(Range(NetworkKind::kCurrent, 1, 1, 1), kNowUs + 7'000);
  EXPECT_EQ(Drain(publisher, kNowUs + 7'000), ChunksOf(NetworkKind::kCurrent, 1, 1, 2));
  publisher.Request(AllOf(1), kNowUs + 12'998);
  EXPECT_FALSE(publisher.Next(kNowUs + 12'998));
}

TEST(WeightPublisher, SendsOnceWhatIsAskedForBeforeItWasSent) {
  WeightPublisher publisher;
  publisher.Offer({NetworkKind::kCurrent, 1}, ParametersOf(1));
  publisher.Request(AllOf(1), kNowUs);
  EXPECT_EQ(Drain(publisher, kNowUs), ChunksOf(NetworkKind::kCurrent, 1));
  EXPECT_EQ(publisher.repeated_chunks(), 0);
}

TEST(WeightPublisher, DropsVersionsThatNoOrderCanName) {
  WeightPublisher publisher;
  for (int32_t version = 0; version < 4; ++version) {
    publisher.Offer({NetworkKind::kCurrent, version}, ParametersOf(static_cast<uint32_t>(version)));
    publisher.Offer({NetworkKind::kTarget, version}, ParametersOf(static_cast<uint32_t>(version)));
  }
  publisher.Retain(3, 2);
  const Sent sent = Drain(publisher, kNowUs);
  EXPECT_EQ(sent.size(), 3u * kChunks);  // current 3, target 2 and 3
  EXPECT_EQ(std::count(sent.begin(), sent.end(), Sent::value_type(NetworkKind::kCurrent, 2, 0)), 0);
  EXPECT_EQ(std::count(sent.begin(), sent.end(), Sent::value_type(NetworkKind::kTarget, 2, 0)), 1);
  publisher.Request(AllOf(2), kNowUs + 50'000);
  EXPECT_FALSE(publisher.Next(kNowUs + 50'000));
  publisher.Request(AllOf(3), kNowUs + 50'000);
  EXPECT_EQ(DrainSorted(publisher, kNowUs + 50'000), ChunksOf(NetworkKind::kCurrent, 3));
}

/// Version 1 of the current network was sent a while ago; now actors ask for it.
class WeightPublisherAsked : public ::testing::Test {
 protected:
  WeightPublisherAsked() {
    publisher_.Offer({NetworkKind::kCurrent, 1}, ParametersOf(1));
    Drain(publisher_, kNowUs);
  }

  void Ask(int32_t first, int32_t count) {
    publisher_.Request(Range(NetworkKind::kCurrent, 1, first, count), kLaterUs);
  }

  static constexpr int64_t kLaterUs = kNowUs + 50'000;
  WeightPublisher publisher_;
};

TEST_F(WeightPublisherAsked, SendsAgainOnceHoweverManyAsk) {
  for (int actor = 0; actor < 5; ++actor) {
    Ask(1, 2);
  }
  EXPECT_EQ(DrainSorted(publisher_, kLaterUs), ChunksOf(NetworkKind::kCurrent, 1, 1, 3));
  EXPECT_EQ(publisher_.sent_chunks(), kChunks + 2);
  EXPECT_EQ(publisher_.repeated_chunks(), 2);
}

TEST_F(WeightPublisherAsked, AnswersTheUnionOfWhatIsMissing) {
  publisher_.Offer({NetworkKind::kTarget, 1}, ParametersOf(2));
  Drain(publisher_, kNowUs);
  Ask(3, 1);
  publisher_.Request(Range(NetworkKind::kTarget, 1, 2, 1), kLaterUs);
  Ask(0, 1);
  EXPECT_EQ(
      DrainSorted(publisher_, kLaterUs),
      (Sent{{NetworkKind::kCurrent, 1, 0}, {NetworkKind::kCurrent, 1, 3}, {NetworkKind::kTarget, 1, 2}}));
}

TEST_F(WeightPublisherAsked, IgnoresNetworksAndVersionsThatItDoesNotHave) {
  chunk_range_t range = Range(NetworkKind::kTarget, 1, 0, kChunks);
  for (const int network : {1, 2, -1, 127, -128}) {
    range.network = static_cast<int8_t>(network);
    publisher_.Request(range, kLaterUs);
  }
  for (const int32_t version : {0, 2, -1, kIntMax, kIntMin}) {
    publisher_.Request(Range(NetworkKind::kCurrent, version, 0, kChunks), kLaterUs);
  }
  EXPECT_FALSE(publisher_.Next(kLaterUs));
}

TEST_F(WeightPublisherAsked, IgnoresAbsurdRanges) {
  for (const auto& [first, count] :
       {std::pair(kChunks, 1), std::pair(-1, 2), std::pair(0, 0), std::pair(0, -1),
        std::pair(kIntMin, kIntMax), std::pair(kIntMax, kIntMax), std::pair(1, kIntMin)}) {
    Ask(first, count);
  }
  EXPECT_FALSE(publisher_.Next(kLaterUs));
}

TEST_F(WeightPublisherAsked, SendsWhatThereIsOfARangeThatReachesFar) {
  Ask(2, kIntMax);
  EXPECT_EQ(DrainSorted(publisher_, kLaterUs), ChunksOf(NetworkKind::kCurrent, 1, 2, 4));
}

}  // namespace
}  // namespace fresco
