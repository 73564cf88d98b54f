// The safe-action mask against exhaustive search, and what follows from its being exact.
#include <gtest/gtest.h>

#include <set>
#include <tuple>
#include <vector>

#include "core/error.h"
#include "tests/worlds/literal_model.h"
#include "tests/worlds/table_one.h"
#include "tests/worlds/test_scenarios.h"
#include "worlds/uav/uav_environment.h"

namespace fresco {
namespace {

class MaskSearch {
 public:
  explicit MaskSearch(const UavWorld& world) : world_(world) {}

  // Visits every situation that any flight comes to, and compares each of its moves.
  void Visit(const UavEnvironment& environment, int hovers) {
    const UavState& state = environment.state();
    if (!visited_.insert({state.slot, state.cell.column, state.cell.row, hovers}).second) {
      return;
    }
    for (int index = 0; index < kMoves; ++index) {
      const auto move = static_cast<Move>(index);
      const Cell next = world_.After(state.cell, move);
      const bool stays = next == state.cell;
      UavEnvironment after = environment;
      const StepResult result = after.Step({move, 0});
      const int slots_left = world_.scenario().slots - after.state().slot;
      const bool some_flight =
          SomeFlightReachesStop(world_.scenario(), next, slots_left, after.remaining_energy_j());
      const bool off_grid = stays && move != Move::kHover;
      EXPECT_EQ(environment.IsSafe(move), some_flight && !off_grid)
          << MoveName(move) << " from " << state.cell.column << ',' << state.cell.row << " in slot "
          << state.slot << " after " << hovers << " hovers";
      ++compared_[some_flight ? 1 : 0];
      if (!result.terminal()) {
        Visit(after, hovers + (stays ? 1 : 0));
      } else if (some_flight) {
        EXPECT_EQ(after.outcome(), Outcome::kArrived);
      }
    }
  }

  int compared(bool safe) const { return compared_[safe ? 1 : 0]; }

 private:
  const UavWorld& world_;
  std::set<std::tuple<int, int, int, int>> visited_;
  int compared_[2] = {0, 0};
};

void ExpectExactMasks(Scenario (*scenario_of)(uint32_t index)) {
  int safe = 0;
  int unsafe = 0;
  for (uint32_t index = 0; index < 200; ++index) {
    const Scenario scenario = scenario_of(index);
    if (scenario.slots > 11) {
      continue;
    }
    SCOPED_TRACE(index);
    const UavWorld world(scenario);
    MaskSearch search(world);
    search.Visit(UavEnvironment(world), 0);
    ASSERT_FALSE(testing::Test::HasFailure());
    safe += search.compared(true);
    unsafe += search.compared(false);
  }
  EXPECT_GT(safe, 1000);
  EXPECT_GT(unsafe, 1000);
}

TEST(SafeActionMask, AdmitsAMoveIffSomeFlightGoesOnToTheStop) {
  ExpectExactMasks(RandomScenario);
}

TEST(SafeActionMask, AdmitsAMoveIffSomeFlightGoesOnRoundTheObstacles) {
  ExpectExactMasks(RandomMapScenario);
}

TEST(SafeActionMask, LetsRandomFlightsAlwaysArrive) {
  for (uint32_t index = 0; index < 2000; ++index) {
    const UavWorld world(index % 2 == 0 ? RandomScenario(index) : RandomMapScenario(index));
    UavEnvironment environment(world);
    RandomStream stream = TestStream(3, index);
    while (environment.outcome() == Outcome::kFlying) {
      environment.Step(RandomAction(world, environment, {.safe_actions = true}, &stream));
    }
    ASSERT_EQ(environment.outcome(), Outcome::kArrived) << index;
    EXPECT_EQ(environment.state().cell, world.scenario().stop);
    EXPECT_EQ(environment.state().slot, world.scenario().slots);
    EXPECT_GE(environment.remaining_energy_j(), 0);
  }
}

// A world is refused for its energy iff exhaustive search finds no flight.
TEST(UavWorld, AcceptsAScenarioIffSomeFlightReachesTheStop) {
  int refused = 0;
  for (uint32_t index = 0; index < 1000; ++index) {
    Scenario scenario = index % 2 == 0 ? RandomScenario(index) : RandomMapScenario(index);
    RandomStream stream = TestStream(4, index);
    scenario.initial_energy_j = 1 + scenario.slots * 200 * stream.NextUniform();
    bool accepted = true;
    try {
      const UavWorld world(scenario);
    } catch (const Error&) {
      accepted = false;
      ++refused;
    }
    EXPECT_EQ(accepted,
              SomeFlightReachesStop(scenario, scenario.start, scenario.slots - 1, scenario.initial_energy_j))
        << index;
  }
  EXPECT_GT(refused, 200);
  EXPECT_LT(refused, 800);
}

// A world in which `slots` slots are to be passed with exactly the energy of `flown` and `hovers`.
Scenario ExactEnergy(Scenario scenario, int flown, int hovers) {
  const UavWorld world(scenario);  // its energies are rounded alike: T P(0) tau is the largest in both
  scenario.initial_energy_j = flown * world.flying_energy_j() + hovers * world.hovering_energy_j();
  return scenario;
}

TEST(Reachability, ExactlyEnoughEnergyIsEnough) {
  for (const int hovers : {0, 2, 10}) {
    Scenario scenario = TableOneScenario();
    scenario.initial_energy_j = 15000;
    scenario = ExactEnergy(scenario, 69 - hovers, hovers);
    const UavWorld world(scenario);
    UavEnvironment environment(world);
    RandomStream stream = TestStream(5, static_cast<uint32_t>(hovers));
    while (environment.outcome() == Outcome::kFlying) {
      const bool hover = environment.IsSafe(Move::kHover);
      environment.Step(hover ? Action{} : RandomAction(world, environment, {.safe_actions = true}, &stream));
    }
    EXPECT_EQ(environment.outcome(), Outcome::kArrived);
    EXPECT_EQ(environment.remaining_energy_j(), 0);
    scenario.initial_energy_j -= 1e-9;
    if (hovers == 0) {
      EXPECT_THROW(UavWorld{scenario}, Error);
    }
  }
}

TEST(Reachability, OnASingleCellAllSlackIsHovered) {
  Scenario scenario = TableOne();
  scenario.columns = scenario.rows = 1;
  scenario.start = scenario.stop = {0, 0};
  scenario.slots = 5;
  scenario.sensors = {{0, 0, 1}};
  scenario.initial_energy_j = 4 * 219.82 - 0.01;  // far more than four slots flown
  EXPECT_THROW(UavWorld{scenario}, Error);
  scenario.initial_energy_j = 4 * 219.82 + 0.01;
  const UavWorld world(scenario);
  EXPECT_TRUE(UavEnvironment(world).IsSafe(Move::kHover));
  EXPECT_FALSE(UavEnvironment(world).IsSafe(Move::kNorth));
}

TEST(Reachability, OnACellThatObstaclesEncloseAllSlackIsHovered) {
  Scenario scenario = SquareField(3, 5, {1, 1}, {1, 1}, {{0, 0, 1}});
  scenario.map = std::make_shared<ObstacleMap>(std::vector<std::string>{".N.", "BSN", ".B."});
  scenario.initial_energy_j = 4 * 219.82 - 0.01;  // far more than four slots flown
  EXPECT_THROW(UavWorld{scenario}, Error);
  scenario.initial_energy_j = 4 * 219.82 + 0.01;
  const UavWorld world(scenario);
  EXPECT_TRUE(UavEnvironment(world).IsSafe(Move::kHover));
  for (const Move move : {Move::kNorth, Move::kSouth, Move::kEast, Move::kWest}) {
    EXPECT_FALSE(UavEnvironment(world).IsSafe(move));
    EXPECT_EQ(world.After({1, 1}, move), (Cell{1, 1}));
  }
}

TEST(Reachability, AnOddSlackTakesAHoverWhereHoveringIsTheDearer) {
  const UavWorld world(TableOneScenario());
  const double flown_j = world.flying_energy_j();
  EXPECT_TRUE(CanReachStop(world, world.DistanceToStop({10, 17}), 4, 4 * flown_j));
  EXPECT_FALSE(CanReachStop(world, world.DistanceToStop({10, 17}), 3, 3 * flown_j));
  EXPECT_TRUE(
      CanReachStop(world, world.DistanceToStop({10, 17}), 3, 2 * flown_j + world.hovering_energy_j()));
  EXPECT_GE(EnergyMargin(world, {10, 17}, 3, 3 * flown_j), 0);  // the paper's Delta does not see it
  EXPECT_FALSE(CanReachStop(world, world.DistanceToStop({10, 17}), 1, 1e6));
}

}  // namespace
}  // namespace fresco
