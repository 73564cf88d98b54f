// Work in turns, by a clock that only the work moves.
#include "tests/bench/alternate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace fresco {
namespace {

using ::testing::ElementsAre;

class AlternateTest : public ::testing::Test {
 protected:
  /// Takes so long and does so much; notes that it was done.
  Work WorkOf(char name, int64_t us, double amount) {
    return [=, this] {
      now_us_ += us;
      order_ += name;
      return amount;
    };
  }
  Speeds Measure(const Work& value, const std::vector<Work>& references, double seconds) {
    return Alternate(value, references, seconds, [this] { return now_us_; });
  }

  int64_t now_us_ = 1'000;
  std::string order_;
};

TEST_F(AlternateTest, DoesEachOnceAndThenFiveTurnsOfEach) {
  Measure(WorkOf('v', 100, 1), {WorkOf('a', 100, 1), WorkOf('b', 100, 1)}, 10 * 100e-6);
  EXPECT_EQ(order_,
            "vab"
            "vab"
            "vab"
            "vab"
            "vab"
            "vab");
}

TEST_F(AlternateTest, GivesHalfOfTheTimeToTheValueAndSharesTheOtherHalf) {
  Measure(WorkOf('v', 100, 1), {WorkOf('a', 100, 1), WorkOf('b', 100, 1)}, 10 * 400e-6);
  EXPECT_EQ(order_.substr(0, 3 + 8),
            "vab"
            "vvvvaabb");
  EXPECT_EQ(order_.size(), 3u + 5 * 8);
}

TEST_F(AlternateTest, ReturnsAmountsASecond) {
  const Speeds speeds = Measure(WorkOf('v', 500, 10), {WorkOf('a', 250, 1), WorkOf('b', 1000, 3)}, 0.1);
  EXPECT_DOUBLE_EQ(speeds.value, 20'000);
  EXPECT_THAT(speeds.references, ElementsAre(testing::DoubleEq(4'000), testing::DoubleEq(3'000)));
}

TEST_F(AlternateTest, CountsTheFastestTurn) {
  int turn = 0;
  const Work uneven = [&] {
    constexpr int64_t kUs[] = {1, 400, 300, 100, 200, 500};  // the first is no turn
    now_us_ += kUs[turn++];
    return 1.0;
  };
  const Speeds speeds = Measure(uneven, {WorkOf('a', 100, 1)}, 10 * 100e-6);
  EXPECT_EQ(turn, 6);
  EXPECT_DOUBLE_EQ(speeds.value, 10'000);
}

}  // namespace
}  // namespace fresco
