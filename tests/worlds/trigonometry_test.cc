#include "worlds/trigonometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/random.h"

namespace fresco {
namespace {

/// How far a value is from the true one, in units of the last place of the true one.
double UnitsApart(double value, long double truth) {
  const double size = std::abs(static_cast<double>(truth));
  const double unit = std::nextafter(size, std::numeric_limits<double>::infinity()) - size;
  return static_cast<double>(std::abs(value - truth)) / unit;
}

TEST(Trigonometry, AgreesWithTheLibraryInLongDouble) {
  constexpr double kAllowedUnits = 1.2;
  constexpr double kRanges[] = {0.3, 4, 1e3, 1e5};
  RandomStream stream(1, RandomPurpose::kTest, 0, 0);
  for (const double range : kRanges) {
    for (int i = 0; i < 20'000; ++i) {
      const double angle = range * (2 * stream.NextUniform() - 1);
      const SineAndCosine<double> result = SineAndCosineOf(angle);
      ASSERT_LE(UnitsApart(result.sine, std::sin(static_cast<long double>(angle))), kAllowedUnits) << angle;
      ASSERT_LE(UnitsApart(result.cosine, std::cos(static_cast<long double>(angle))), kAllowedUnits) << angle;
    }
  }
}

TEST(Trigonometry, IsExactAtZeroAndRightAtTheQuarters) {
  EXPECT_EQ(SineAndCosineOf(0).sine, 0);
  EXPECT_EQ(SineAndCosineOf(0).cosine, 1);
  constexpr double kQuarter = 1.5707963267948966;  // the double below pi / 2
  const double expected[][2] = {{0, 1}, {1, 0}, {0, -1}, {-1, 0}};
  for (int quarters = -8; quarters <= 8; ++quarters) {
    const SineAndCosine result = SineAndCosineOf(quarters * kQuarter);
    EXPECT_NEAR(result.sine, expected[(quarters + 8) % 4][0], 1e-15) << quarters;
    EXPECT_NEAR(result.cosine, expected[(quarters + 8) % 4][1], 1e-15) << quarters;
  }
}

// Worlds refuse a state that is not finite, so it must not become finite here.
TEST(Trigonometry, GivesNanForWhatIsNotFinite) {
  for (const double angle : {std::numeric_limits<double>::infinity(), std::nan("")}) {
    EXPECT_TRUE(std::isnan(SineAndCosineOf(angle).sine));
    EXPECT_TRUE(std::isnan(SineAndCosineOf(angle).cosine));
  }
}

// Values of the definition itself: no compiler may fuse or reorder it.
TEST(Trigonometry, HasTheBitsOfItsDefinition) {
  EXPECT_EQ(SineAndCosineOf(0.1).sine, 0x1.98eaecb8bcb2cp-4);
  EXPECT_EQ(SineAndCosineOf(2.5).cosine, -0x1.9a2f7ef858b7dp-1);
}

}  // namespace
}  // namespace fresco
