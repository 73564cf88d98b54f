#include "paper/flight_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/files.h"
#include "tests/report/picture_files.h"
#include "tests/support/temporary_folder.h"
#include "tests/worlds/table_one.h"
#include "worlds/uav/baselines.h"
#include "worlds/uav/flight.h"

namespace fresco {
namespace {

/// A grid that is not square, three sensors (one between cells), 30 slots.
UavWorld SmallWorld() {
  Scenario scenario = TableOne();
  scenario.columns = 12;
  scenario.rows = 8;
  scenario.slots = 30;
  scenario.start = {1, 0};
  scenario.stop = {10, 7};
  scenario.coverage_radius_m = 50;
  scenario.sensors = {{50, 50, 1}, {212.5, 137.5, 1}, {250, 25, 1}};
  return UavWorld(scenario);
}

/// A sensor within the radius that was scheduled over a cell.
struct Collection {
  Cell cell;
  Sensor sensor;
};

/// The collections of a flight, from the distances themselves.
std::vector<Collection> Collections(const UavWorld& world, const Episode& flight) {
  std::vector<Collection> collections;
  for (size_t slot = 0; slot <= flight.actions.size(); ++slot) {
    const int scheduled = ActionIn(world, flight, slot).schedule;
    if (scheduled > 0) {
      const Cell cell = CellIn(flight.state(slot));
      const Sensor& sensor = world.scenario().sensors[static_cast<size_t>(scheduled - 1)];
      const double distance_m = std::hypot(cell.column * world.scenario().cell_m - sensor.x_m,
                                           cell.row * world.scenario().cell_m - sensor.y_m);
      if (distance_m <= world.scenario().coverage_radius_m) {
        collections.push_back({cell, sensor});
      }
    }
  }
  return collections;
}

TEST(FlightMap, ShowsThePathSlotBySlotWithinItsCells) {
  const UavWorld world = SmallWorld();
  const Episode flight = FlyBaseline(world, BaselineKind::kAoi);
  const auto path = DataBlock(DrawFlightMap("map", world, flight).script, "path");
  const std::vector<UavState> states = StatesIn(flight);
  ASSERT_EQ(path.size(), states.size());
  for (size_t i = 0; i < path.size(); ++i) {
    ASSERT_EQ(path[i].size(), 3U);
    EXPECT_LT(std::abs(path[i][0] - states[i].cell.column), 0.5);
    EXPECT_LT(std::abs(path[i][1] - states[i].cell.row), 0.5);
    EXPECT_EQ(path[i][2], static_cast<double>(i + 1));
  }
}

TEST(FlightMap, JoinsEveryCollectionWithItsSensor) {
  const UavWorld world = SmallWorld();
  const Episode flight = FlyBaseline(world, BaselineKind::kDistance);
  const std::vector<Collection> expected = Collections(world, flight);
  ASSERT_GT(expected.size(), 3U);
  const auto shown = DataBlock(DrawFlightMap("map", world, flight).script, "collections");
  ASSERT_EQ(shown.size(), expected.size());
  for (size_t i = 0; i < shown.size(); ++i) {
    const auto& [cell, sensor] = expected[i];
    EXPECT_LT(std::abs(shown[i][0] - cell.column), 0.5);
    EXPECT_LT(std::abs(shown[i][1] - cell.row), 0.5);
    EXPECT_NEAR(shown[i][0] + shown[i][2], sensor.x_m / 25, 1e-9);
    EXPECT_NEAR(shown[i][1] + shown[i][3], sensor.y_m / 25, 1e-9);
  }
}

TEST(FlightMap, LeavesOutSchedulesWithoutCoverage) {
  const UavWorld world = SmallWorld();
  const Episode flight = Fly(world, [&](const UavEnvironment& environment) {
    const bool east = environment.state().cell.column < world.scenario().stop.column;
    const bool north = environment.state().cell.row < world.scenario().stop.row;
    return Action{east ? Move::kEast : north ? Move::kNorth : Move::kHover, 2};
  });
  const std::vector<Collection> expected = Collections(world, flight);
  const auto shown = DataBlock(DrawFlightMap("map", world, flight).script, "collections");
  EXPECT_EQ(shown.size(), expected.size());
  EXPECT_LT(shown.size(), flight.actions.size());
}

TEST(FlightMap, HasTheSensorsInCellsWithTheirNumbers) {
  const UavWorld world = SmallWorld();
  const auto sensors =
      DataBlock(DrawFlightMap("map", world, FlyBaseline(world, BaselineKind::kAoi)).script, "sensors");
  ASSERT_EQ(sensors.size(), 3U);
  const double expected[3][4] = {
      {2, 2, 2, 1}, {8.5, 5.5, 2, 2}, {10, 1, 2, 3}};  // column, row, radius, number
  for (size_t n = 0; n < 3; ++n) {
    for (size_t i = 0; i < 4; ++i) {
      EXPECT_DOUBLE_EQ(sensors[n][i], expected[n][i]) << n << " " << i;
    }
  }
}

TEST(FlightMap, IsTwoFilesThatStayTheSame) {
  const UavWorld world = SmallWorld();
  const Picture picture = DrawFlightMap("AoI-based", world, FlyBaseline(world, BaselineKind::kAoi));
  const TemporaryFolder folder;
  WritePicture(picture, folder.path() / "map");
  WritePicture(picture, folder.path() / "again");
  ASSERT_TRUE(ParsesAsXml(folder.path() / "map.svg"));
  const std::string svg = ReadFile(folder.path() / "map.svg");
  for (const char* text : {"AoI-based", "column", "row", "slot", "start", "stop", "path"}) {
    EXPECT_EQ(Count(svg, std::string("<text>") + text + "</text>"), 1) << text;
  }
  EXPECT_EQ(svg, ReadFile(folder.path() / "again.svg"));
  const std::string png = ReadFile(folder.path() / "map.png");
  EXPECT_EQ(png, ReadFile(folder.path() / "again.png"));
  EXPECT_EQ(PngSize(png), std::pair(2U * picture.width_px, 2U * picture.height_px));
}

TEST(FlightMap, CanBeDrawnOfAFlightThatEndedEarlyWithoutCollections) {
  const UavWorld world = SmallWorld();
  const Episode flight = Fly(world, [](const UavEnvironment&) { return Action{Move::kHover, 0}; });
  ASSERT_FALSE(Arrived(flight));
  const TemporaryFolder folder;
  WritePicture(DrawFlightMap("hovered", world, flight), folder.path() / "map");
  EXPECT_TRUE(ParsesAsXml(folder.path() / "map.svg"));
}

}  // namespace
}  // namespace fresco
