// What the weight publisher sends again when actors ask for it.
#include <gtest/gtest.h>

#include <utility>

#include "tests/learner/weight_samples.h"

namespace fresco {
namespace {

/// Version 1 of the current network was sent, a while ago.
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
