// World::Formulate of every world against Observe and WriteMask, to the bit.
#include "worlds/formulas.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/worlds/formula_values.h"
#include "tests/worlds/table_one.h"
#include "tests/worlds/test_scenarios.h"
#include "tests/worlds/walk_world.h"
#include "worlds/acrobot/acrobot.h"
#include "worlds/cartpole/cartpole.h"
#include "worlds/episode.h"
#include "worlds/uav/uav_fields.h"
#include "worlds/uav/uav_world.h"

namespace fresco {
namespace {

/// Compares in every state of some random episodes. Returns how many states that were.
int Compare(const World& world, int episodes) {
  Formulas formulas;
  const std::optional<StateFormulas> formulated = world.Formulate(formulas);
  EXPECT_TRUE(formulated && formulated->mask);
  RandomStream stream = TestStream(60, 0);
  std::vector<float> observation(static_cast<size_t>(world.observation_size()));
  int states = 0;
  for (int episode = 0; episode < episodes; ++episode) {
    EpisodeRecorder recorder(world, static_cast<uint64_t>(episode));
    while (!recorder.ended()) {
      const std::vector<std::vector<double>> values = ValuesOf(formulas, recorder.state());
      world.Observe(recorder.state(), observation);
      EXPECT_EQ(values[static_cast<size_t>(formulated->observation.index)],
                std::vector<double>(observation.begin(), observation.end()));
      EXPECT_EQ(values[static_cast<size_t>(formulated->mask->index)],
                std::vector<double>(recorder.mask().begin(), recorder.mask().end()));
      recorder.Step(RandomAllowedAction(recorder.mask(), stream));
      ++states;
    }
    if (::testing::Test::HasFailure()) {
      return states;
    }
  }
  return states;
}

TEST(Formulas, OfOneFieldAreWhatTheWorldComputes) {
  for (uint32_t index = 0; index < 200; ++index) {
    const Scenario scenario = index % 2 == 0 ? RandomScenario(index) : RandomMapScenario(index);
    for (const NetworkInputOptions input :
         {NetworkInputOptions{false, false}, NetworkInputOptions{true, false},
          NetworkInputOptions{false, true}}) {
      const UavOptions options{{index % 3 != 0, index % 5 != 0, index % 7 < 4}, input};
      EXPECT_GT(Compare(UavWorld(scenario, options), 3), 0) << index;
    }
  }
}

TEST(Formulas, OfTheMaskKnowTheEnergyThatIsNeeded) {
  Scenario scenario = TableOneScenario();
  scenario.rotor = LiteratureRotor();
  const int slots = scenario.slots - 1;
  scenario.initial_energy_j = 1e9;
  const UavWorld plenty(scenario);
  // Enough for every second spare slot.
  const int distance = plenty.DistanceToStop(scenario.start);
  scenario.initial_energy_j =
      CompletionEnergy(plenty, distance, slots) +
      (slots - distance) / 2 * (plenty.flying_energy_j() - plenty.hovering_energy_j());
  EXPECT_GT(Compare(UavWorld(scenario, {{true, true}, {}}), 50), 0);
}

TEST(Formulas, OfDrawnFieldsAreWhatTheWorldComputes) {
  const UavFields fields(TableOne(), {{1, 5}, {0.5, 2}, {50, 125}, {50, 70}, true, true},
                         {{true, true, true}, {}});
  EXPECT_GT(Compare(fields, 150), 5000);
  const UavFields without_masks(TableOne(), {{2, 4}, {1, 1}, {50, 125}, {70, 70}, false, false}, {});
  EXPECT_GT(Compare(without_masks, 50), 1000);
  const UavFields idle(TableOne(), {{1, 3}, {1, 1}, {50, 125}, {70, 70}, false, false}, {{.idle = true}, {}});
  EXPECT_GT(Compare(idle, 50), 1000);
}

TEST(Formulas, OfCartPoleAndAcrobotAreWhatTheWorldsCompute) {
  EXPECT_GT(Compare(CartPole(500), 100), 1000);
  EXPECT_GT(Compare(Acrobot(500), 10), 1000);
}

TEST(Formulas, AreNoneIfAWorldDoesNotStateThem) {
  Formulas formulas;
  EXPECT_FALSE(WalkWorld().Formulate(formulas));
}

}  // namespace
}  // namespace fresco
