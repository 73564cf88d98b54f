#include "worlds/uav/rotor.h"

#include <gtest/gtest.h>

#include "tests/worlds/literal_model.h"
#include "tests/worlds/test_scenarios.h"

namespace fresco {
namespace {

TEST(Rotor, OfTableOneNeedsTwiceAsMuchForHovering) {
  EXPECT_DOUBLE_EQ(PropulsionPower(Rotor{}, 0), 99.66 + 120.16);
  EXPECT_NEAR(PropulsionPower(Rotor{}, 25), 112.876, 5e-4);
}

// 99.66 (1 + 3 * 625 / 14400) + 120.16 * 0.002 / 25 + 0.5 * 0.48 * 1.225 * 0.0001 * 0.5 * 15625.
TEST(Rotor, KeepsTheInducedTermWhereThePrintedFormCancels) {
  EXPECT_NEAR(PropulsionPower(Rotor{}, 25), 112.6365625 + 0.0096128 + 0.2296875, 1e-9);
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

}  // namespace
}  // namespace fresco
