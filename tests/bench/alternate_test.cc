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

TEST_F(AlternateTest, DoesEachOnceAndThenTakesTurnsUntilTheTimeIsOver) {
  Measure(WorkOf('v', 10'000, 1), {WorkOf('a', 10'000, 1), WorkOf('b', 10'000, 1)}, 0.24);
  EXPECT_EQ(order_, std::string("vab") + "vabvabvabvabvab" + "vabvab");
}

TEST_F(AlternateTest, RepeatsAWorkForTenMilliseconds) {
  Measure(WorkOf('v', 5'000, 1), {WorkOf('a', 4'000, 1)}, 0.11);
  EXPECT_EQ(order_, std::string("va") + "vvaaavvaaavvaaavvaaavvaaa");
}

TEST_F(AlternateTest, TakesShorterTurnsIfThereIsLittleTime) {
  Measure(WorkOf('v', 100, 1), {WorkOf('a', 50, 1)}, 10 * 100e-6);
  EXPECT_EQ(order_, std::string("va") + "vaavaavaavaavaa");
}

TEST_F(AlternateTest, TakesFiveTurnsOfWorkThatTakesLonger) {
  Measure(WorkOf('v', 500'000, 1), {WorkOf('a', 100, 1)}, 10 * 100e-6);
  EXPECT_EQ(order_, std::string("va") + "vavavavava");
}

TEST_F(AlternateTest, ReturnsAmountsASecond) {
  const Speeds speeds = Measure(WorkOf('v', 500, 10), {WorkOf('a', 250, 1), WorkOf('b', 1000, 3)}, 0.1);
  EXPECT_DOUBLE_EQ(speeds.value, 20'000);
  EXPECT_THAT(speeds.references, ElementsAre(testing::DoubleEq(4'000), testing::DoubleEq(3'000)));
  EXPECT_DOUBLE_EQ(SpeedOf(WorkOf('v', 500, 10), 0.1, [this] { return now_us_; }), 20'000);
}

TEST_F(AlternateTest, CountsTheFastestTurn) {
  size_t turn = 0;
  const Work uneven = [&] {
    constexpr int64_t kUs[] = {1, 400, 300, 100, 200, 500};  // the first is no turn
    now_us_ += kUs[turn++];
    return 1.0;
  };
  const Speeds speeds = Measure(uneven, {WorkOf('a', 100, 1)}, 10 * 100e-6);
  EXPECT_EQ(turn, 6u);
  EXPECT_DOUBLE_EQ(speeds.value, 10'000);
}

}  // namespace
}  // namespace fresco
