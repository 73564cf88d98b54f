#include "worlds/uav/baselines.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/worlds/table_one.h"
#include "tests/worlds/test_scenarios.h"
#include "worlds/uav/aoi_figures.h"

namespace fresco {
namespace {

constexpr BaselineKind kKinds[] = {BaselineKind::kAoi, BaselineKind::kDistance};

// One row of seven cells, sensors over some of them, each covered from its own cell only.
Scenario RowScenario(int slots, int home_column, const std::vector<int>& sensor_columns) {
  Scenario scenario = TableOne();
  scenario.columns = 7;
  scenario.rows = 1;
  scenario.slots = slots;
  scenario.start = scenario.stop = {home_column, 0};
  scenario.coverage_radius_m = 0;
  for (const int column : sensor_columns) {
    scenario.sensors.push_back({25.0 * column, 0, 1});
  }
  return scenario;
}

void ExpectFlight(const UavWorld& world, const Episode& flight, const std::vector<int>& columns,
                  const std::vector<int>& scheduled) {
  std::vector<int> flown_columns;
  std::vector<int> flown_scheduled;
  for (size_t slot = 0; slot <= flight.actions.size(); ++slot) {
    flown_columns.push_back(StateIn(flight, slot).cell.column);
    flown_scheduled.push_back(ActionIn(world, flight, slot).schedule);
  }
  EXPECT_EQ(flown_columns, columns);
  EXPECT_EQ(flown_scheduled, scheduled);
  EXPECT_TRUE(Arrived(flight));
}

TEST(AoiBaseline, FliesToTheOldestSensorAndHomeInTime) {
  const UavWorld world(RowScenario(14, 0, {1, 5}));
  ExpectFlight(world, FlyBaseline(world, BaselineKind::kAoi),  //
               {0, 1, 2, 3, 4, 5, 4, 3, 2, 1, 2, 1, 0, 0}, {0, 1, 0, 0, 0, 2, 0, 0, 0, 1, 0, 1, 0, 0});
}

// The round 1, 2, 3 ends over sensor 3, with which the next one therefore begins: 3, 2, 1; then 1, 2.
TEST(DistanceBaseline, FliesInRoundsToTheNearestSensor) {
  const UavWorld world(RowScenario(20, 2, {1, 3, 6}));
  ExpectFlight(world, FlyBaseline(world, BaselineKind::kDistance),
               {2, 1, 2, 3, 4, 5, 6, 6, 5, 4, 3, 2, 1, 1, 2, 3, 4, 3, 2, 2},
               {0, 1, 0, 2, 0, 0, 3, 3, 0, 0, 2, 0, 1, 1, 0, 2, 0, 2, 0, 0});
}

TEST(Baselines, FlyAlongTheLongerAxisAndColumnsFirst) {
  const UavWorld world(SquareField(5, 30, {0, 0}, {0, 0}, {{50, 75, 1}}, 0));
  const std::vector<Move> expected = {Move::kNorth, Move::kEast,  Move::kNorth,
                                      Move::kEast,  Move::kNorth, Move::kHover};
  for (const BaselineKind kind : kKinds) {
    const Episode flight = FlyBaseline(world, kind);
    for (size_t slot = 0; slot < expected.size(); ++slot) {
      EXPECT_EQ(ActionIn(world, flight, slot).move, expected[slot]) << slot;
    }
  }
}

TEST(Baselines, ServeTheOldestCoveredSensorOnTheWay) {
  Scenario scenario = RowScenario(20, 0, {0, 1, 2});
  scenario.coverage_radius_m = 1000;
  const UavWorld world(scenario);
  for (const BaselineKind kind : kKinds) {
    const Episode flight = FlyBaseline(world, kind);
    for (int slot = 0; slot < 19; ++slot) {
      EXPECT_EQ(ActionIn(world, flight, static_cast<size_t>(slot)).schedule, slot % 3 + 1);
    }
  }
}

TEST(Baselines, AimAtTheNearestCellOfTheGrid) {
  Scenario scenario = RowScenario(20, 0, {});
  scenario.sensors = {{62.5, 300, 1}};  // half-way between columns 2 and 3, far north of the grid
  const UavWorld world(scenario);
  for (const BaselineKind kind : kKinds) {
    const Episode flight = FlyBaseline(world, kind);
    EXPECT_EQ(StateIn(flight, 2).cell, (Cell{2, 0}));
    EXPECT_EQ(StateIn(flight, 12).cell, (Cell{2, 0}));
  }
}

TEST(Baselines, AlwaysArrive) {
  for (uint32_t index = 0; index < 10000; ++index) {
    const UavWorld world(index % 2 == 0 ? RandomScenario(index) : RandomMapScenario(index));
    for (const BaselineKind kind : kKinds) {
      ASSERT_TRUE(Arrived(FlyBaseline(world, kind))) << index;
    }
  }
}

// Nineteen slots flown but one: the second hover over the sensor is out of reach. Over the stop the
// slack that is left can't be hovered either, and is flown to and fro.
TEST(Baselines, FlyHomeForGoodOnceAWantedMoveIsOutOfReach) {
  Scenario scenario = RowScenario(20, 0, {3});
  scenario.initial_energy_j = 18 * 112.8758628 + 219.82 + 1;
  const UavWorld world(scenario);
  for (const BaselineKind kind : kKinds) {
    ExpectFlight(world, FlyBaseline(world, kind),
                 {0, 1, 2, 3, 3, 2, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0},
                 {0, 0, 0, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  }
}

// A house that radio does not pass, with a yard. The sensor stands in the yard, which opens to the north.
Scenario YardScenario() {
  Scenario scenario = SquareField(7, 40, {3, 0}, {3, 0}, {{75, 75, 1}}, 60);
  scenario.map = std::make_shared<ObstacleMap>(std::vector<std::string>{
      ".......",
      ".......",
      "..B.B..",
      "..B.B..",
      "..BBB..",
      ".......",
      "...S...",
  });
  return scenario;
}

TEST(Baselines, FlyRoundObstaclesAndServeWhatTheySee) {
  const UavWorld world(YardScenario());
  for (const BaselineKind kind : kKinds) {
    const Episode flight = FlyBaseline(world, kind);
    int first = 0;
    while (ActionIn(world, flight, static_cast<size_t>(first)).schedule == 0) {
      ++first;
    }
    // From (3, 5) on, straight above the sensor, 50 m; 9 moves are the shortest way there.
    EXPECT_EQ(first, 9);
    EXPECT_EQ(StateIn(flight, static_cast<size_t>(first)).cell, (Cell{3, 5}));
    EXPECT_TRUE(Arrived(flight));
  }
}

TEST(Baselines, FlyOverAMapWithoutObstaclesAsWithoutAMap) {
  for (uint32_t index = 0; index < 500; ++index) {
    Scenario scenario = RandomScenario(index);
    const Episode open = FlyBaseline(UavWorld(scenario), BaselineKind::kAoi);
    scenario.map = std::make_shared<ObstacleMap>(std::vector<std::string>(
        static_cast<size_t>(scenario.rows), std::string(static_cast<size_t>(scenario.columns), '.')));
    const UavWorld world(scenario);
    bool seen = true;  // by some cell; otherwise the baselines aim at another cell
    for (int sensor = 0; sensor < world.sensors(); ++sensor) {
      bool covered = false;
      for (int cell = 0; cell < scenario.columns * scenario.rows; ++cell) {
        covered = covered || world.Covers({cell % scenario.columns, cell / scenario.columns}, sensor);
      }
      seen = seen && covered;
    }
    EXPECT_TRUE(!seen || SameBits(open, FlyBaseline(world, BaselineKind::kAoi))) << index;
  }
}

TEST(Baselines, BeginAfreshAfterReset) {
  const UavWorld world(TableOneScenario());
  for (const BaselineKind kind : kKinds) {
    Baseline baseline(kind, world);
    const auto policy = [&](const UavEnvironment& environment) { return baseline.Choose(environment); };
    const Episode first = Fly(world, policy);
    baseline.Reset();
    EXPECT_EQ(Figures(world, Fly(world, policy)).total_aoi, Figures(world, first).total_aoi);
  }
}

// A first trial reported 3,590 to 3,690, rounded; the optimum is 2789. This is a regression check only:
// the exact totals are this code's own, and the rule that a target is chosen after the slot's
// transmission was settled with that trial in view (before it, kAoi comes to 3393).
TEST(Baselines, KeepTheirTotalsOnTheSharedInstance) {
  const UavWorld world(TableOneScenario());
  EXPECT_EQ(Figures(world, FlyBaseline(world, BaselineKind::kAoi)).total_aoi, 3684);
  EXPECT_EQ(Figures(world, FlyBaseline(world, BaselineKind::kDistance)).total_aoi, 3589);
}

}  // namespace
}  // namespace fresco
