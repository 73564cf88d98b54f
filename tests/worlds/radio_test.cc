#include "worlds/uav/radio.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace fresco {
namespace {

using testing::HasSubstr;

// (2^5 - 1) * 1e-13 W / 1e-6 * (100^2 + 120^2) m^2.
TEST(Radio, NeedsThePowerOfTableOneForAHundredMetres) {
  EXPECT_NEAR(TransmitPower(Radio{}, 1, 100), 31e-7 * 24400, 1e-12);
  EXPECT_NEAR(TransmitPower(Radio{}, 1, 100), 0.07564, 1e-12);
}

TEST(Radio, RadiusIsTheInverseOfPower) {
  for (const double radius_m : {0.0, 1.0, 25.0, 100.0, 1234.5}) {
    EXPECT_NEAR(CoverageRadius(Radio{}, 1, TransmitPower(Radio{}, 1, radius_m)), radius_m, 1e-4);
  }
}

TEST(Radio, HalfTheTimeForAnUpdateNeedsTheSquareOfTheSignal) {
  const double ratio = TransmitPower(Radio{}, 0.5, 100) / TransmitPower(Radio{}, 1, 100);
  EXPECT_NEAR(ratio, 1023.0 / 31.0, 1e-9);
}

TEST(Radio, RefusesAPowerThatDoesNotReachTheGround) {
  try {
    CoverageRadius(Radio{}, 1, 0.01);
    FAIL() << "0.01 W was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kUsage);
    EXPECT_THAT(error.what(), HasSubstr("scenario.transmit_power_w: 0.01 is out of range"));
    EXPECT_THAT(error.what(), HasSubstr("0.0446"));
  }
}

TEST(Radio, RefusesValuesOutOfRange) {
  Radio radio;
  radio.bandwidth_hz = 0;
  EXPECT_THROW(TransmitPower(radio, 1, 100), Error);
  EXPECT_THROW(CoverageRadius(radio, 1, 1), Error);
  EXPECT_THROW(TransmitPower(Radio{}, 1e-3, 100), Error);  // 5000 bit/s/Hz
  EXPECT_THROW(TransmitPower(Radio{}, 1, -1), Error);
}

}  // namespace
}  // namespace fresco
