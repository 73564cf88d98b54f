// The environment against the second statement of the model, on random scenarios and actions.
#include "tests/worlds/literal_model.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "tests/worlds/test_scenarios.h"
#include "worlds/uav/uav_environment.h"

namespace fresco {
namespace {

void ExpectSame(const UavEnvironment& environment, const LiteralState& expected, int slot) {
  const UavState& state = environment.state();
  EXPECT_EQ(state.slot, slot);
  EXPECT_EQ(state.cell, expected.cell);
  EXPECT_EQ(state.time_margin, expected.phi);
  EXPECT_NEAR(state.energy_margin_j, expected.delta_j, 1e-3);  // a float
  EXPECT_NEAR(environment.remaining_energy_j(), expected.remaining_j, 1e-6);
  EXPECT_EQ(std::vector<int>(state.aoi.begin(), state.aoi.end()), expected.aoi);
  EXPECT_EQ(OutcomeName(environment.outcome()), expected.outcome);
}

// Flies one random episode, half of them with safe actions only; returns its outcome.
std::string FlyBesideTheLiteralModel(const Scenario& scenario, uint32_t index) {
  const UavWorld world(scenario);
  UavEnvironment environment(world);
  RandomStream stream = TestStream(2, index);
  const MaskOptions options{.safe_actions = index % 2 == 0, .coverage = index % 3 == 0};
  std::vector<Action> actions;
  ExpectSame(environment, SimulateLiterally(scenario, actions), 1);
  while (environment.outcome() == Outcome::kFlying) {
    actions.push_back(RandomAction(world, environment, options, &stream));
    const StepResult result = environment.Step(actions.back());
    const LiteralState expected = SimulateLiterally(scenario, actions);
    ExpectSame(environment, expected, static_cast<int>(actions.size()) + 1);
    EXPECT_NEAR(result.reward, expected.reward, 1e-12);
    EXPECT_EQ(result.ending, expected.outcome == "flying" ? Ending::kNone : Ending::kTerminal);
  }
  return OutcomeName(environment.outcome());
}

void ExpectAgreement(Scenario (*scenario_of)(uint32_t index), uint32_t flights) {
  std::map<std::string, int> outcomes;
  for (uint32_t index = 0; index < flights; ++index) {
    SCOPED_TRACE(index);
    ++outcomes[FlyBesideTheLiteralModel(scenario_of(index), index)];
    ASSERT_FALSE(testing::Test::HasFailure());
  }
  EXPECT_GT(outcomes["arrived"], 100);
  EXPECT_GT(outcomes["out of time"], 100);
  EXPECT_GT(outcomes["out of energy"], 100);
  EXPECT_EQ(outcomes.size(), 3u);
}

TEST(LiteralModel, AgreesWithTheEnvironmentOnRandomFlights) {
  ExpectAgreement(RandomScenario, 6000);
}

TEST(LiteralModel, AgreesWithTheEnvironmentAmongObstacles) {
  ExpectAgreement(RandomMapScenario, 2000);
}

}  // namespace
}  // namespace fresco
