#include "learner/weight_publisher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/learner/literal_crc32c.h"
#include "tests/learner/weight_samples.h"

namespace fresco {
namespace {

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
    const uint32_t crc = LiteralCrc32c(*parameters);
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

}  // namespace
}  // namespace fresco
