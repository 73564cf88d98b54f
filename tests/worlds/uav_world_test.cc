#include "worlds/uav/uav_world.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "tests/worlds/facts.h"
#include "tests/worlds/test_scenarios.h"
#include "tests/worlds/walk_world.h"
#include "worlds/uav/aoi_figures.h"
#include "worlds/uav/baselines.h"
#include "worlds/uav/physics.h"

namespace fresco {
namespace {

using testing::ElementsAre;

TEST(UavWorld, HasTheSizesOfThePaper) {
  const UavWorld world(TableOneScenario());
  EXPECT_EQ(world.sensors(), 3);
  EXPECT_EQ(world.actions(), 20);
  EXPECT_EQ(world.longest_episode(), 69);
}

TEST(UavWorld, DescribesItself) {
  const UavWorld world(TableOneScenario(), {.network_input = {.sensor_geometry = true}});
  const WorldDescription& description = world.description();
  EXPECT_EQ(description.name, "uav");
  EXPECT_EQ(world.state_size(), 7);
  EXPECT_EQ(world.observation_size(), 3 + 4 + 2 * 3);
  EXPECT_EQ(description.state[kColumnField].name, "column");
  EXPECT_EQ(description.state[kRowField].name, "row");
  EXPECT_EQ(description.state[kTimeMarginField].name, "time_margin");
  EXPECT_EQ(description.state[kEnergyMarginField].name, "energy_margin_j");
  EXPECT_EQ(description.state[kAoiField].name, "aoi_1");
  EXPECT_EQ(description.state[kAoiField + 2].name, "aoi_3");
  EXPECT_EQ(description.actions[static_cast<size_t>(world.ActionIndex({Move::kNorth, 0}))], "north");
  EXPECT_EQ(description.actions[static_cast<size_t>(world.ActionIndex({Move::kEast, 3}))], "east, sensor 3");
  EXPECT_FALSE(description.random);
  EXPECT_TRUE(description.repeatable);
}

TEST(UavWorld, JudgesByTheAoiFigures) {
  const UavWorld world(TableOneScenario());
  const Episode flight = FlyBaseline(world, BaselineKind::kAoi);
  ASSERT_EQ(world.description().figures.size(), 3u);
  std::vector<double> figures(3);
  world.Judge(flight, figures);
  const AoiFigures expected = Figures(world, flight);
  EXPECT_THAT(figures,
              ElementsAre(expected.average_aoi, static_cast<double>(expected.total_aoi), expected.sum_aoi));
  EXPECT_EQ(world.description().figures[0].name, "average_aoi");
  EXPECT_TRUE(world.description().less_is_better);
  EXPECT_TRUE(world.Succeeded(flight));
}

TEST(UavWorld, HasItsCellsAsPlacesAndLeadsToThem) {
  Scenario scenario = TableOneScenario();
  scenario.columns = 11;  // not as many as rows
  const UavWorld world(scenario);
  ASSERT_TRUE(world.has_places());
  RandomStream stream = TestStream(8, 0);
  std::set<int> drawn;
  std::vector<float> state(static_cast<size_t>(world.state_size()));
  for (int draw = 0; draw < 3000; ++draw) {
    const int place = world.DrawPlace(stream);
    ASSERT_TRUE(place >= 0 && place < 11 * 20);
    drawn.insert(place);
    const Cell goal{place % 11, place / 11};
    ASSERT_EQ(world.CellIndex(goal), place);
    const Cell cell{draw % 11, draw % 20};
    state[kColumnField] = static_cast<float>(cell.column);
    state[kRowField] = static_cast<float>(cell.row);
    const ActionRange range = world.Towards(state, place);
    EXPECT_EQ(world.IsAt(state, place), cell == goal);
    for (int action = range.first; action < range.end; ++action) {
      EXPECT_EQ(world.ActionAt(action), (Action{MoveTowards(cell, goal), action - range.first}));
    }
    EXPECT_EQ(range.end - range.first, world.sensors() + 1);
  }
  EXPECT_EQ(drawn.size(), 11u * 20u);
}

/// Two slots of flight and a hover. Sensor 1 is collected in the first slot: its AoI is 1, 1, 2, 3; that of
/// sensor 2 is 1, 2, 3, 4.
TEST(UavWorld, TellsAFlightSlotBySlot) {
  Scenario scenario = TableOneScenario();
  scenario.columns = 3;
  scenario.rows = 2;
  scenario.slots = 4;
  scenario.start = {0, 0};
  scenario.stop = {1, 1};
  scenario.sensors = {{0, 0, 1}, {0, 0, 3}};
  const UavWorld world(scenario);
  const std::vector<Action> actions = {{Move::kNorth, 1}, {Move::kEast, 0}, {Move::kHover, 0}};
  const EpisodeAccount account = world.Tell(Fly(world, [&](const UavEnvironment& environment) {
    return actions[static_cast<size_t>(environment.state().slot) - 1];
  }));
  const double residual_j =
      scenario.initial_energy_j - 2 * world.flying_energy_j() - world.hovering_energy_j();
  EXPECT_NEAR(residual_j, 21554.43, 0.01);
  EXPECT_EQ(account.sentence, "arrived; average AoI 2.312 slots, total AoI 17, 21554 J left");
  EXPECT_THAT(account.facts,
              ElementsAre(IsFact("arrived", true), IsFact("outcome", "arrived"), IsFact("slots", int64_t{4}),
                          IsFact("total_aoi", int64_t{17}), IsFact("average_aoi", (7 + 3 * 10) / 4.0 / 4),
                          IsFact("sum_aoi", 4.25), IsFact("residual_energy_j", residual_j)));
  EXPECT_EQ(account.steps_name, "flight");
  EXPECT_THAT(account.columns, ElementsAre("slot", "column", "row", "move", "scheduled", "aoi"));
  const auto line = [](int64_t slot, int64_t column, int64_t row, const char* move, int64_t scheduled,
                       const std::vector<int64_t>& aoi) {
    return std::vector<AccountValue>{slot, column, row, move, scheduled, aoi};
  };
  EXPECT_THAT(account.steps,
              ElementsAre(line(1, 0, 0, "north", 1, {1, 1}), line(2, 0, 1, "east", 0, {1, 2}),
                          line(3, 1, 1, "hover", 0, {2, 3}), line(4, 1, 1, "hover", 0, {3, 4})));
}

TEST(UavWorld, TellsHowAFlightFailed) {
  const UavWorld world(TableOneScenario());
  const EpisodeAccount account = world.Tell(Fly(world, [](const UavEnvironment&) {
    return Action{Move::kSouth, 0};
  }));
  EXPECT_THAT(account.sentence, testing::StartsWith("out of time; "));
  EXPECT_THAT(account.facts[0], IsFact("arrived", false));
  EXPECT_THAT(account.facts[1], IsFact("outcome", "out of time"));
}

TEST(UavWorld, IsKnownAmongOtherWorlds) {
  const UavWorld uav(TableOneScenario());
  const WalkWorld walk;
  EXPECT_EQ(AsUavWorld(uav), &uav);
  EXPECT_EQ(AsUavWorld(walk), nullptr);
}

TEST(UavWorld, HasTheEnergiesOfTableOne) {
  const UavWorld world(TableOneScenario());
  EXPECT_NEAR(world.hovering_energy_j(), 219.82, 1e-9);
  EXPECT_NEAR(world.flying_energy_j(), 112.8758628, 1e-7);
  EXPECT_EQ(world.scenario().initial_energy_j, 22000);
}

TEST(UavWorld, SumsEnergiesWithoutRounding) {
  Scenario scenario = TableOneScenario();
  scenario.initial_energy_j = 12345.6789;
  const UavWorld world(scenario);
  double remaining_j = world.scenario().initial_energy_j;
  for (int slot = 0; slot < 69; ++slot) {
    remaining_j -= slot % 3 == 0 ? world.hovering_energy_j() : world.flying_energy_j();
  }
  for (int slot = 68; slot >= 0; --slot) {
    remaining_j += slot % 2 == 0 ? world.flying_energy_j() : world.hovering_energy_j();
  }
  // 23 hovers and 46 flown down, 34 hovers and 35 flown up.
  EXPECT_EQ(remaining_j - 11 * world.hovering_energy_j() + 11 * world.flying_energy_j(),
            world.scenario().initial_energy_j);
}

TEST(UavWorld, NormalisesTheWeights) {
  Scenario scenario = TableOneScenario();
  scenario.sensors[1].weight = 2;
  scenario.sensors[2].weight = 0;
  const UavWorld world(scenario);
  EXPECT_THAT(world.theta(), ElementsAre(1.0 / 3, 2.0 / 3, 0.0));
}

TEST(UavWorld, NumbersEveryActionOnce) {
  const UavWorld world(TableOneScenario());
  for (int index = 0; index < world.actions(); ++index) {
    EXPECT_EQ(world.ActionIndex(world.ActionAt(index)), index);
  }
  EXPECT_EQ(world.ActionIndex({Move::kNorth, 0}), 0);
  EXPECT_EQ(world.ActionIndex({Move::kEast, 3}), 11);
  EXPECT_EQ(world.ActionIndex({Move::kHover, 3}), 19);
}

TEST(UavWorld, MovesNorthUpAndEastRightAndStopsAtTheBorder) {
  const UavWorld world(TableOneScenario());
  EXPECT_EQ(world.After({5, 6}, Move::kNorth), (Cell{5, 7}));
  EXPECT_EQ(world.After({5, 6}, Move::kSouth), (Cell{5, 5}));
  EXPECT_EQ(world.After({5, 6}, Move::kEast), (Cell{6, 6}));
  EXPECT_EQ(world.After({5, 6}, Move::kWest), (Cell{4, 6}));
  EXPECT_EQ(world.After({5, 6}, Move::kHover), (Cell{5, 6}));
  EXPECT_EQ(world.After({0, 0}, Move::kWest), (Cell{0, 0}));
  EXPECT_EQ(world.After({0, 0}, Move::kSouth), (Cell{0, 0}));
  EXPECT_EQ(world.After({19, 19}, Move::kEast), (Cell{19, 19}));
  EXPECT_EQ(world.After({19, 19}, Move::kNorth), (Cell{19, 19}));
}

TEST(UavWorld, NamesItsMoves) {
  std::set<std::string> names;
  for (int move = 0; move < kMoves; ++move) {
    names.insert(MoveName(static_cast<Move>(move)));
  }
  EXPECT_EQ(names, (std::set<std::string>{"east", "hover", "north", "south", "west"}));
}

TEST(UavWorld, CoversADiscIncludingItsEdge) {
  const UavWorld world(TableOneScenario());  // sensor 0 over cell (8, 7), R = 4 cells
  int covered = 0;
  for (int column = 0; column < 20; ++column) {
    for (int row = 0; row < 20; ++row) {
      const bool inside = (column - 8) * (column - 8) + (row - 7) * (row - 7) <= 16;
      EXPECT_EQ(world.Covers({column, row}, 0), inside);
      covered += inside;
    }
  }
  EXPECT_EQ(covered, 49);
  EXPECT_TRUE(world.Covers({12, 7}, 0));
}

TEST(UavWorld, CoversTheSameCellsWhenTheRadiusComesFromItsPower) {
  Scenario scenario = TableOneScenario();
  scenario.coverage_radius_m = CoverageRadius(scenario.radio, scenario.slot_s, 31e-7 * 24400);  // 100 m
  EXPECT_TRUE(UavWorld(scenario).Covers({12, 7}, 0));
}

TEST(MoveTowards, TakesTheLongerAxisAndColumnsAtEqualDistances) {
  EXPECT_EQ(MoveTowards({3, 3}, {3, 3}), Move::kHover);
  EXPECT_EQ(MoveTowards({3, 3}, {5, 4}), Move::kEast);
  EXPECT_EQ(MoveTowards({3, 3}, {1, 4}), Move::kWest);
  EXPECT_EQ(MoveTowards({3, 3}, {4, 5}), Move::kNorth);
  EXPECT_EQ(MoveTowards({3, 3}, {2, 0}), Move::kSouth);
  EXPECT_EQ(MoveTowards({3, 3}, {2, 2}), Move::kWest);
  EXPECT_EQ(MoveTowards({3, 3}, {4, 4}), Move::kEast);
}

}  // namespace
}  // namespace fresco
