#include "worlds/uav/physics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/error_of.h"
#include "tests/worlds/literal_model.h"
#include "tests/worlds/table_one.h"
#include "tests/worlds/test_scenarios.h"

namespace fresco {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(Rotor, OfTableOneNeedsTwiceAsMuchForHovering) {
  EXPECT_DOUBLE_EQ(PropulsionPower(TableOne().rotor, 0), 99.66 + 120.16);
  EXPECT_NEAR(PropulsionPower(TableOne().rotor, 25), 112.876, 5e-4);
}

// 99.66 (1 + 3 * 625 / 14400) + 120.16 * 0.002 / 25 + 0.5 * 0.48 * 1.225 * 0.0001 * 0.5 * 15625.
TEST(Rotor, KeepsTheInducedTermWhereThePrintedFormCancels) {
  EXPECT_NEAR(PropulsionPower(TableOne().rotor, 25), 112.6365625 + 0.0096128 + 0.2296875, 1e-9);
}

TEST(Rotor, OfTheLiteratureNeedsMoreForFlying) {
  EXPECT_NEAR(PropulsionPower(LiteratureRotor(), 0), 168.49, 1e-9);
  EXPECT_NEAR(PropulsionPower(LiteratureRotor(), 25), 249, 1);
}

TEST(Rotor, AgreesWithThePrintedFormulaWhereThatIsStable) {
  for (int speed = 0; speed <= 40; ++speed) {
    EXPECT_NEAR(PropulsionPower(LiteratureRotor(), speed), LiteralPower(LiteratureRotor(), speed), 1e-9);
  }
}

// P = (2^5 - 1) * 1e-13 W / 1e-6 * (R^2 + 120^2) m^2; in half the time the signal needs 2^10 - 1.
TEST(Radio, ReachesAsFarAsThePowerWorkedByHand) {
  for (const double radius_m : {0.0, 1.0, 25.0, 100.0, 1234.5}) {
    const double distance_squared = radius_m * radius_m + 120 * 120;
    EXPECT_NEAR(CoverageRadius(TableOne().radio, 1, 31e-7 * distance_squared * (1 + 1e-13)), radius_m, 1e-4);
    EXPECT_NEAR(CoverageRadius(TableOne().radio, 0.5, 1023e-7 * distance_squared * (1 + 1e-13)), radius_m,
                1e-4);
  }
  EXPECT_NEAR(CoverageRadius(TableOne().radio, 1, 0.07564), 100, 1e-6);
}

TEST(Radio, RefusesAPowerThatDoesNotReachTheGround) {
  EXPECT_THAT(ErrorOf([] { CoverageRadius(TableOne().radio, 1, 0.01); }),
              AllOf(HasSubstr("scenario.transmit_power_w: 0.01 is out of range"), HasSubstr("0.0446")));
}

TEST(Radio, RefusesAnUpdateThatNoSignalCouldCarry) {
  Radio radio = TableOne().radio;
  radio.bandwidth_hz = 0;
  EXPECT_THROW(CoverageRadius(radio, 1, 1), Error);
  EXPECT_THROW(CoverageRadius(TableOne().radio, 1e-3, 1), Error);  // 5000 bit/s/Hz
}

}  // namespace
}  // namespace fresco
