#include "worlds/uav/world.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "tests/worlds/test_scenarios.h"
#include "worlds/uav/physics.h"

namespace fresco {
namespace {

using testing::ElementsAre;

TEST(World, HasTheSizesOfThePaper) {
  const World world(TableOneScenario());
  EXPECT_EQ(world.sensors(), 3);
  EXPECT_EQ(world.actions(), 20);
  EXPECT_EQ(world.maximum_transitions(), 69);
}

TEST(World, HasTheEnergiesOfTableOne) {
  const World world(TableOneScenario());
  EXPECT_NEAR(world.hovering_energy_j(), 219.82, 1e-9);
  EXPECT_NEAR(world.flying_energy_j(), 112.8758628, 1e-7);
  EXPECT_EQ(world.scenario().initial_energy_j, 22000);
}

TEST(World, SumsEnergiesWithoutRounding) {
  Scenario scenario = TableOneScenario();
  scenario.initial_energy_j = 12345.6789;
  const World world(scenario);
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

TEST(World, NormalisesTheWeights) {
  Scenario scenario = TableOneScenario();
  scenario.sensors[1].weight = 2;
  scenario.sensors[2].weight = 0;
  const World world(scenario);
  EXPECT_THAT(world.theta(), ElementsAre(1.0 / 3, 2.0 / 3, 0.0));
}

TEST(World, NumbersEveryActionOnce) {
  const World world(TableOneScenario());
  for (int index = 0; index < world.actions(); ++index) {
    EXPECT_EQ(world.ActionIndex(world.ActionAt(index)), index);
  }
  EXPECT_EQ(world.ActionIndex({Move::kNorth, 0}), 0);
  EXPECT_EQ(world.ActionIndex({Move::kEast, 3}), 11);
  EXPECT_EQ(world.ActionIndex({Move::kHover, 3}), 19);
}

TEST(World, MovesNorthUpAndEastRightAndStopsAtTheBorder) {
  const World world(TableOneScenario());
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

TEST(World, NamesItsMoves) {
  std::set<std::string> names;
  for (int move = 0; move < kMoves; ++move) {
    names.insert(MoveName(static_cast<Move>(move)));
  }
  EXPECT_EQ(names, (std::set<std::string>{"east", "hover", "north", "south", "west"}));
}

TEST(World, CoversADiscIncludingItsEdge) {
  const World world(TableOneScenario());  // sensor 0 over cell (8, 7), R = 4 cells
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

TEST(World, CoversTheSameCellsWhenTheRadiusComesFromItsPower) {
  Scenario scenario = TableOneScenario();
  scenario.coverage_radius_m = CoverageRadius(scenario.radio, scenario.slot_s, 31e-7 * 24400);  // 100 m
  EXPECT_TRUE(World(scenario).Covers({12, 7}, 0));
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
