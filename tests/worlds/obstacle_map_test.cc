// Maps: their text, the shortest ways against Floyd and Warshall, the line of sight against a literal
// version, and what worlds make of them.
#include "worlds/uav/obstacle_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <set>

#include "tests/support/error_of.h"
#include "tests/worlds/literal_model.h"
#include "tests/worlds/table_one.h"
#include "tests/worlds/test_scenarios.h"
#include "worlds/uav/flight.h"
#include "worlds/uav/map_input.h"
#include "worlds/uav/uav_fields.h"
#include "worlds/uav/ways.h"

namespace fresco {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

using Rows = std::vector<std::string>;

Rows RandomRows(int columns, int rows, RandomStream* stream) {
  constexpr char kCharacters[] = "....NRBS";
  Rows text(static_cast<size_t>(rows));
  for (std::string& row : text) {
    for (int column = 0; column < columns; ++column) {
      row.push_back(kCharacters[Between(stream, 0, 7)]);
    }
  }
  return text;
}

TEST(ObstacleMap, HasItsNorthernRowFirst) {
  const Rows rows = {"N.R", "SB."};
  const ObstacleMap map(rows);
  EXPECT_EQ(map.columns(), 3);
  EXPECT_EQ(map.rows(), 2);
  EXPECT_EQ(map.Text(), rows);
  EXPECT_EQ(map.KindOf({0, 1}), CellKind::kNoFlying);
  EXPECT_EQ(map.KindOf({2, 1}), CellKind::kBlocksRadio);
  EXPECT_EQ(map.KindOf({0, 0}), CellKind::kStartAndLanding);
  EXPECT_EQ(map.KindOf({1, 0}), CellKind::kBlocksBoth);
  EXPECT_TRUE(map.MayFly({2, 1}));
  EXPECT_FALSE(map.MayFly({0, 1}));
  EXPECT_FALSE(map.MayFly({1, 0}));
  EXPECT_FALSE(map.MayFly({-1, 0}));
  EXPECT_FALSE(map.MayFly({0, 2}));
  EXPECT_TRUE(map.BlocksRadio({1, 0}));
  EXPECT_FALSE(map.BlocksRadio({0, 1}));
}

TEST(ObstacleMap, ListsWhereFlightsMayStartFromTheSouthWest) {
  const ObstacleMap map({"S.S", "..S", "SS."});
  EXPECT_THAT(map.zones(), ElementsAre(Cell{0, 0}, Cell{1, 0}, Cell{2, 1}, Cell{0, 2}, Cell{2, 2}));
}

TEST(ObstacleMap, RefusesWhatIsNoMap) {
  const auto refusal = [](const Rows& rows) { return ErrorOf([&] { ObstacleMap{rows}; }); };
  EXPECT_THAT(refusal({}), HasSubstr("at least one row"));
  EXPECT_THAT(refusal({""}), HasSubstr("at least one row"));
  EXPECT_THAT(refusal({"..", "..."}), HasSubstr("scenario.map_row[1]: 3 cells; allowed: 2"));
  EXPECT_THAT(refusal({"...", ".x."}),
              AllOf(HasSubstr("scenario.map_row[1]"), HasSubstr("'x' in column 1"), HasSubstr("'R'")));
  EXPECT_THAT(refusal(Rows(65, std::string(64, '.'))),
              HasSubstr("64 x 65 cells are too many; allowed: a product"));
  EXPECT_EQ(ObstacleMap(Rows(64, std::string(64, '.'))).Distance({0, 0}, {63, 63}), 126);
}

TEST(ObstacleMap, HasTheShortestWaysOfFloydAndWarshall) {
  for (uint32_t index = 0; index < 60; ++index) {
    RandomStream stream = TestStream(40, index);
    const int columns = Between(&stream, 1, 8);
    const int rows = Between(&stream, 1, 7);
    const ObstacleMap map(RandomRows(columns, rows, &stream));
    const int cells = columns * rows;
    const auto cell = [&](int i) { return Cell{i % columns, i / columns}; };
    std::vector<std::vector<int>> distance(static_cast<size_t>(cells),
                                           std::vector<int>(static_cast<size_t>(cells)));
    const auto at = [&](int i, int j) -> int& {
      return distance[static_cast<size_t>(i)][static_cast<size_t>(j)];
    };
    for (int i = 0; i < cells; ++i) {
      for (int j = 0; j < cells; ++j) {
        const bool may_fly = map.MayFly(cell(i)) && map.MayFly(cell(j));
        const int apart = std::abs(cell(i).column - cell(j).column) + std::abs(cell(i).row - cell(j).row);
        at(i, j) = may_fly && apart <= 1 ? apart : ObstacleMap::kCutOff;
      }
    }
    for (int k = 0; k < cells; ++k) {
      for (int i = 0; i < cells; ++i) {
        for (int j = 0; j < cells; ++j) {
          at(i, j) = std::min(at(i, j), at(i, k) + at(k, j));
        }
      }
    }
    for (int i = 0; i < cells; ++i) {
      std::vector<Cell> around;
      for (int j = 0; j < cells; ++j) {
        ASSERT_EQ(map.Distance(cell(i), cell(j)), at(i, j)) << index;
        if (at(i, j) < ObstacleMap::kCutOff) {
          around.push_back(cell(j));
        }
      }
      ASSERT_EQ(map.CellsAround(cell(i)), around) << index;
    }
  }
}

TEST(ObstacleMap, HidesWhatStandsBehindAHouse) {
  const ObstacleMap map({".....", ".....", ".BR..", ".....", "....."});
  const auto sees = [&](Cell cell, double x_m, double y_m) {
    return map.HasLineOfSight(cell, {x_m, y_m, 1}, 10);
  };
  EXPECT_FALSE(sees({1, 0}, 10, 40));  // straight through
  EXPECT_FALSE(sees({2, 0}, 20, 40));
  EXPECT_TRUE(sees({0, 0}, 0, 40));  // past it
  EXPECT_TRUE(sees({3, 0}, 30, 40));
  EXPECT_TRUE(sees({3, 3}, 20, 40));  // over the corner's outside
  EXPECT_TRUE(sees({3, 1}, 0, 0));
  EXPECT_FALSE(sees({0, 2}, 40, 20));  // along it, through both
  EXPECT_TRUE(sees({0, 3}, 40, 30));   // beside it
  // On the line between row 2 and row 3, which is the houses' edge, and just south of it.
  EXPECT_TRUE(sees({0, 3}, 40, 25));
  EXPECT_FALSE(sees({0, 2}, 40, 25));
  // Exactly through a corner of the houses, at (2.5, 1.5), and a little to the north of it.
  EXPECT_TRUE(sees({1, 0}, 40, 30));
  EXPECT_FALSE(sees({1, 0}, 40, 30.1));
  EXPECT_TRUE(sees({1, 0}, 40, 29.9));
  // A sensor that stands on a house hides behind others only; over a house, the UAV hears only what stands
  // there.
  EXPECT_TRUE(sees({2, 0}, 20, 20));
  EXPECT_FALSE(sees({4, 2}, 10, 20));
  EXPECT_TRUE(sees({2, 2}, 20, 20));
  EXPECT_TRUE(sees({2, 2}, 23, 17));
  EXPECT_FALSE(sees({2, 2}, 20, 40));
  EXPECT_FALSE(sees({2, 2}, 40, 20));
}

TEST(ObstacleMap, SeesBetweenHousesThatTouchAtACorner) {
  const ObstacleMap map({"...", ".B.", "B.."});
  EXPECT_TRUE(map.HasLineOfSight({1, 0}, {0, 25, 1}, 25));  // through the point where the two meet
  EXPECT_FALSE(map.HasLineOfSight({1, 0}, {0, 26, 1}, 25));
}

TEST(ObstacleMap, HasTheLineOfSightOfALiteralVersion) {
  int seen = 0;
  int hidden = 0;
  for (uint32_t index = 0; index < 300; ++index) {
    RandomStream stream = TestStream(41, index);
    Scenario scenario;
    scenario.columns = Between(&stream, 1, 9);
    scenario.rows = Between(&stream, 1, 9);
    scenario.cell_m = index % 2 == 0 ? 25 : 0.1;
    scenario.map = std::make_shared<ObstacleMap>(RandomRows(scenario.columns, scenario.rows, &stream));
    for (int sensor = 0; sensor < 30; ++sensor) {
      // A third are in the centres of cells, a third on multiples of a quarter of a cell, a third anywhere.
      const auto place = [&](int cells) {
        const double at = stream.NextUniform() * cells - 0.5;
        const double step = sensor % 3 == 0 ? 1 : 0.25;
        const double rounded = sensor % 3 == 2 ? at : std::round(at / step) * step;
        return std::clamp(rounded, -0.5, cells - 0.5) * scenario.cell_m;
      };
      const Sensor at = {place(scenario.columns), place(scenario.rows), 1};
      for (int column = 0; column < scenario.columns; ++column) {
        for (int row = 0; row < scenario.rows; ++row) {
          const bool sees = scenario.map->HasLineOfSight({column, row}, at, scenario.cell_m);
          ASSERT_EQ(sees, HasLineOfSightLiterally(scenario, {column, row}, at))
              << index << ": from " << column << ", " << row << " to " << at.x_m << ", " << at.y_m;
          ++(sees ? seen : hidden);
        }
      }
    }
  }
  EXPECT_GT(seen, 10000);
  EXPECT_GT(hidden, 10000);
}

TEST(ObstacleMap, SeesTheSameIfTheLastBitsOfAPlaceDiffer) {
  RandomStream stream = TestStream(42, 0);
  const ObstacleMap map(RandomRows(12, 12, &stream));
  const double cell_m = 0.1;
  for (int number = 0; number < 144; ++number) {
    const double x_m = number % 12 * cell_m;
    const double y_m = number / 12 * cell_m;
    for (int cell = 0; cell < 144; ++cell) {
      const Cell from = {cell % 12, cell / 12};
      EXPECT_EQ(map.HasLineOfSight(from, {x_m, y_m, 1}, cell_m),
                map.HasLineOfSight(from, {std::nextafter(x_m, 1e9), std::nextafter(y_m, -1e9), 1}, cell_m));
    }
  }
}

// On maps, not every move of two shortest ways is alike: the longer axis first, as on an open grid, if it
// leads closer.
TEST(MoveTowards, IsTheFirstMoveOfAShortestWayRoundObstacles) {
  int other = 0;
  for (uint32_t index = 0; index < 100; ++index) {
    RandomStream stream = TestStream(43, index);
    const ObstacleMap map(RandomRows(6, 6, &stream));
    for (int a = 0; a < 36; ++a) {
      for (int b = 0; b < 36; ++b) {
        const Cell from = {a % 6, a / 6};
        const Cell to = {b % 6, b / 6};
        const Move move = MoveTowards(&map, from, to);
        const Cell step = kMoveSteps[static_cast<size_t>(move)];
        const Cell next = {from.column + step.column, from.row + step.row};
        const int distance = map.Distance(from, to);
        if (from == to || distance == ObstacleMap::kCutOff) {
          EXPECT_EQ(move, Move::kHover);
          continue;
        }
        ASSERT_TRUE(map.MayFly(next));
        EXPECT_EQ(map.Distance(next, to), distance - 1);
        const Cell straight = kMoveSteps[static_cast<size_t>(MoveTowards(from, to))];
        const Cell open = {from.column + straight.column, from.row + straight.row};
        const bool leads_closer = map.MayFly(open) && map.Distance(open, to) < distance;
        EXPECT_EQ(move == MoveTowards(from, to), leads_closer);
        other += !leads_closer;
      }
    }
  }
  EXPECT_GT(other, 1000);
}

// What a world does among no obstacles at all does not depend on whether there is a map.
TEST(UavWorldWithAMap, IsAnOpenGridIfEveryCellIsFree) {
  for (uint32_t index = 0; index < 500; ++index) {
    Scenario scenario = RandomScenario(index);
    const UavOptions options{{index % 2 == 0, true}, {}};
    const UavWorld open(scenario, options);
    scenario.map = std::make_shared<ObstacleMap>(
        Rows(static_cast<size_t>(scenario.rows), std::string(static_cast<size_t>(scenario.columns), '.')));
    const UavWorld mapped(scenario, options);
    EpisodeRecorder recorder(open, 0);
    RandomStream stream = TestStream(44, index);
    while (!recorder.ended()) {
      recorder.Step(RandomAllowedAction(recorder.mask(), stream));
    }
    Episode again;
    ASSERT_TRUE(FlyActions(mapped, 0, recorder.episode().actions, again)) << index;
    EXPECT_TRUE(SameBits(recorder.episode(), again)) << index;
  }
}

TEST(UavWorldWithAMap, RefusesWhatDoesNotFitIt) {
  Scenario scenario = SquareField(5, 30, {0, 0}, {4, 4}, {{50, 50, 1}});
  const auto refusal = [&](const Rows& rows) {
    scenario.map = std::make_shared<ObstacleMap>(rows);
    return ErrorOf([&] { UavWorld{scenario}; });
  };
  EXPECT_THAT(refusal(Rows(4, ".....")), AllOf(HasSubstr("scenario.grid: 5 columns and 5 rows contradict"),
                                               HasSubstr("which has 5 and 4")));
  EXPECT_THAT(refusal({".....", ".....", ".....", ".....", "N...."}),
              AllOf(HasSubstr("scenario.start: column 0, row 0"), HasSubstr("'N'")));
  EXPECT_THAT(refusal({"....B", ".....", ".....", ".....", "....."}),
              AllOf(HasSubstr("scenario.stop: column 4, row 4"), HasSubstr("'B'")));
  EXPECT_THAT(refusal({".....", "BBNBB", ".....", ".....", "....."}),
              AllOf(HasSubstr("scenario.stop: column 4, row 4 is cut off from scenario.start"),
                    HasSubstr("15 cells")));
  scenario.slots = 9;
  EXPECT_THAT(refusal({".....", ".NNNN", ".....", "NNNN.", "....."}),
              AllOf(HasSubstr("scenario.slots: 9 is out of range"), HasSubstr("16 moves")));
  scenario.slots = 30;
  scenario.sensors = {{50, 113, 1}};
  EXPECT_THAT(refusal(Rows(5, ".....")), HasSubstr("scenario.sensor[0].y_m"));
}

TEST(RandomSensors, StandInCentresOfCellsThatAreFreeAndReached) {
  Scenario scenario = SquareField(5, 30, {0, 0}, {0, 0}, {});
  scenario.map = std::make_shared<ObstacleMap>(Rows{"..B..", ".NB..", "RRBBB", "..R..", "SS..."});
  std::set<std::pair<double, double>> places;
  for (uint64_t seed = 0; seed < 300; ++seed) {
    const std::vector<Sensor> sensors = RandomSensors(scenario, 4, seed);
    std::set<std::pair<double, double>> of_this;
    for (const Sensor& sensor : sensors) {
      of_this.insert({sensor.x_m / 25, sensor.y_m / 25});
      EXPECT_EQ(sensor.weight, 1);
    }
    EXPECT_EQ(of_this.size(), 4u);  // in different cells
    places.insert(of_this.begin(), of_this.end());
    const std::vector<Sensor> more = RandomSensors(scenario, 9, seed);
    for (size_t i = 0; i < sensors.size(); ++i) {
      EXPECT_EQ(sensors[i].x_m, more[i].x_m);
      EXPECT_EQ(sensors[i].y_m, more[i].y_m);
    }
  }
  // The two rows in the south without the house, and the three cells in the north-west behind a house that
  // can be flown over. Not the north-east, which is cut off.
  EXPECT_EQ(places.size(), 12u);
  EXPECT_EQ(places.count({0, 3}), 1u);
  EXPECT_EQ(places.count({3, 4}), 0u);
  EXPECT_EQ(places.count({2, 1}), 0u);
  EXPECT_THAT(ErrorOf([&] { RandomSensors(scenario, 13, 1); }),
              AllOf(HasSubstr("13 sensors are too many"), HasSubstr("12 cells without an obstacle")));
}

// A street between two houses, with start and landing at both ends.
Scenario TownScenario() {
  Scenario scenario = SquareField(6, 30, {0, 0}, {5, 5}, {{50, 125, 1}}, 60);
  scenario.map =
      std::make_shared<ObstacleMap>(Rows{"....SS", ".BB.N.", ".BB.N.", "......", ".RRR..", "SS...."});
  return scenario;
}

constexpr UavOptions kMasks{{true, true}, {}};

UavFields TownFields() {
  return UavFields(TownScenario(), {{1, 4}, {1, 1}, {30, 75}, {25, 30}, true, true}, kMasks);
}

TEST(UavFieldsWithAMap, DrawStartAndStopWhereFlightsMayStartAndEnd) {
  const UavFields fields = TownFields();
  std::set<std::pair<int, int>> starts;
  std::set<std::pair<int, int>> stops;
  for (uint64_t seed = 0; seed < 200; ++seed) {
    const Scenario field = fields.Draw(seed);
    EXPECT_EQ(field.map, TownFields().Draw(seed).map == nullptr ? nullptr : field.map);
    starts.insert({field.start.column, field.start.row});
    stops.insert({field.stop.column, field.stop.row});
  }
  const std::set<std::pair<int, int>> zones = {{0, 0}, {1, 0}, {4, 5}, {5, 5}};
  EXPECT_EQ(starts, zones);
  EXPECT_EQ(stops, zones);
}

TEST(UavFieldsWithAMap, AreFlownAsWorldsOfOneField) {
  const UavFields fields = TownFields();
  for (uint64_t seed = 0; seed < 200; ++seed) {
    EpisodeRecorder recorder(fields, seed);
    RandomStream stream(seed, RandomPurpose::kTest, 0, 0);
    while (!recorder.ended()) {
      recorder.Step(RandomAllowedAction(recorder.mask(), stream));
    }
    EXPECT_TRUE(fields.Succeeded(recorder.episode()));
    const UavWorld field(fields.Draw(seed), kMasks);
    const Episode in_its_field = fields.InItsField(field, recorder.episode());
    Episode flown;
    ASSERT_TRUE(FlyActions(field, seed, in_its_field.actions, flown)) << seed;
    EXPECT_TRUE(SameBits(flown, in_its_field)) << seed;
  }
}

/// The inputs of the way to the nearest of some cells: its length / S, then how much shorter it is after each
/// move.
std::vector<float> WayTo(const Scenario& scenario, Cell cell, const std::vector<Cell>& cells) {
  const auto length = [&](Cell from) {
    int least = 2 * std::max(scenario.columns, scenario.rows);
    for (const Cell to : cells) {
      least = std::min(least, LiteralDistance(scenario, from, to));
    }
    return least;
  };
  std::vector<float> way = {static_cast<float>(length(cell)) /
                            static_cast<float>(std::max(scenario.columns, scenario.rows))};
  for (const auto& [columns, rows] : {std::pair(0, 1), {0, -1}, {1, 0}, {-1, 0}}) {
    const Cell next = {cell.column + columns, cell.row + rows};
    way.push_back(MayFlyLiterally(scenario, next) ? static_cast<float>(length(cell) - length(next)) : 0.0f);
  }
  return way;
}

std::vector<Cell> CellsThatCover(const UavWorld& world, int sensor) {
  std::vector<Cell> cells;
  for (int row = 0; row < world.scenario().rows; ++row) {
    for (int column = 0; column < world.scenario().columns; ++column) {
      if (world.Covers({column, row}, sensor)) {
        cells.push_back({column, row});
      }
    }
  }
  return cells;
}

TEST(OpenWays, AreThoseOfALiteralVersion) {
  RandomStream stream(3, RandomPurpose::kTest, 0, 0);
  for (int trial = 0; trial < 300; ++trial) {
    Scenario scenario = SquareField(7, 30, {0, 0}, {0, 0}, {});
    scenario.columns = 1 + static_cast<int>(stream.NextBelow(9));
    scenario.rows = 1 + static_cast<int>(stream.NextBelow(9));
    const auto coordinate = [&](int cells) { return (cells * stream.NextUniform() - 0.5) * scenario.cell_m; };
    // Some sensors stand where rounding decides; some radii cover nothing, some everything.
    const bool whole = trial % 3 == 0;
    const auto placed = [&](int cells) {
      return whole ? static_cast<double>(stream.NextBelow(static_cast<uint32_t>(cells))) * scenario.cell_m
                   : coordinate(cells);
    };
    const Sensor sensor = {placed(scenario.columns), placed(scenario.rows), 1};
    const double radius_m =
        whole ? stream.NextBelow(6) * scenario.cell_m : stream.NextUniform() * stream.NextUniform() * 400;
    std::vector<Cell> covering;
    for (int row = 0; row < scenario.rows; ++row) {
      for (int column = 0; column < scenario.columns; ++column) {
        if (IsWithin(radius_m, HorizontalDistance({column, row}, scenario.cell_m, sensor))) {
          covering.push_back({column, row});
        }
      }
    }
    const Cell stop = {static_cast<int>(stream.NextBelow(static_cast<uint32_t>(scenario.columns))),
                       static_cast<int>(stream.NextBelow(static_cast<uint32_t>(scenario.rows)))};
    const int longer_side = std::max(scenario.columns, scenario.rows);
    std::vector<float> input(kWayInputs);
    for (int row = 0; row < scenario.rows; ++row) {
      for (int column = 0; column < scenario.columns; ++column) {
        const Cell cell = {column, row};
        WriteWays(OpenWaysToStop(scenario.columns, scenario.rows, cell, stop), longer_side, input);
        ASSERT_EQ(input, WayTo(scenario, cell, {stop}));
        WriteWays(OpenWaysToSensor(scenario.columns, scenario.rows, scenario.cell_m, cell, sensor, radius_m),
                  longer_side, input);
        ASSERT_EQ(input, WayTo(scenario, cell, covering)) << trial;
      }
    }
  }
}

// An observation has 12 numbers of the UAV and 12 of each sensor; the last five of them are those of a way.
TEST(UavFieldsWithAMap, ShowTheNetworkTheWaysRoundTheObstacles) {
  const UavFields fields = TownFields();
  EXPECT_EQ(fields.observation_size(), 12 + 4 * 12);
  ASSERT_TRUE(fields.description().sets.has_value());
  EXPECT_EQ(fields.description().sets->own_inputs, 12);
  EXPECT_EQ(fields.description().sets->item_inputs, 12);
  std::vector<float> observation(static_cast<size_t>(fields.observation_size()));
  const auto part = [&](size_t first) {
    return std::vector<float>(observation.begin() + static_cast<int64_t>(first),
                              observation.begin() + static_cast<int64_t>(first) + 5);
  };
  for (uint64_t seed = 0; seed < 60; ++seed) {
    const UavWorld field(fields.Draw(seed), kMasks);
    EpisodeRecorder recorder(fields, seed);
    RandomStream stream(seed, RandomPurpose::kTest, 0, 0);
    while (!recorder.ended()) {
      fields.Observe(recorder.state(), observation);
      const Cell cell = CellIn(recorder.state());
      ASSERT_EQ(part(7), WayTo(field.scenario(), cell, {field.scenario().stop}));
      for (int sensor = 0; sensor < 4; ++sensor) {
        const size_t first = 12 + 12 * static_cast<size_t>(sensor);
        if (sensor < field.sensors()) {
          ASSERT_EQ(part(first + 7), WayTo(field.scenario(), cell, CellsThatCover(field, sensor))) << seed;
          ASSERT_EQ(observation[first + 4], field.Covers(cell, sensor) ? 1 : 0);
        } else {
          ASSERT_EQ(part(first), std::vector<float>(5, 0));
          ASSERT_EQ(part(first + 7), std::vector<float>(5, 0));
        }
      }
      recorder.Step(RandomAllowedAction(recorder.mask(), stream));
    }
  }
}

TEST(NetworkInputWithAMap, HasWaysRoundTheObstacles) {
  Scenario scenario = TownScenario();
  scenario.sensors.push_back({125, 0, 2});
  const UavWorld world(scenario, {{}, {.sensor_geometry = false, .sets = true}});
  scenario.map = nullptr;
  const UavWorld open(scenario, {{}, {.sensor_geometry = false, .sets = true}});
  EXPECT_EQ(open.observation_size(), 12 + 2 * 12);
  EXPECT_EQ(world.observation_size(), 12 + 2 * 12);
  const std::vector<float> state = {3, 2, 8, 500, 7, 9};
  std::vector<float> input(static_cast<size_t>(world.observation_size()));
  std::vector<float> open_input(static_cast<size_t>(open.observation_size()));
  world.Observe(state, input);
  open.Observe(state, open_input);
  const auto expect_way = [&](size_t first, const std::vector<Cell>& to, const std::vector<Cell>& open_to) {
    for (const auto& [of_world, numbers, cells] :
         {std::tuple(&world.scenario(), &input, &to), std::tuple(&open.scenario(), &open_input, &open_to)}) {
      const auto begin = numbers->begin() + static_cast<int64_t>(first);
      EXPECT_EQ(std::vector<float>(begin, begin + 5), WayTo(*of_world, {3, 2}, *cells));
      numbers->erase(begin, begin + 5);
    }
  };
  expect_way(31, CellsThatCover(world, 1), CellsThatCover(open, 1));
  expect_way(19, CellsThatCover(world, 0), CellsThatCover(open, 0));
  expect_way(7, {{5, 5}}, {{5, 5}});
  EXPECT_EQ(input[11], 0);       // the first sensor is hidden,
  EXPECT_EQ(open_input[11], 0);  // and too far away
  EXPECT_EQ(input, open_input);
}

TEST(UavFieldsWithAMap, RefuseStartsAndStopsThatAreCutOff) {
  Scenario scenario = TownScenario();
  scenario.map =
      std::make_shared<ObstacleMap>(Rows{"....SS", "......", "......", "......", "BBB...", "S.B..."});
  scenario.start = {4, 5};
  const FieldRanges ranges = {{1, 4}, {1, 1}, {30, 75}, {25, 30}, true, false};
  EXPECT_THAT(
      ErrorOf([&] { UavFields(scenario, ranges, kMasks); }),
      AllOf(HasSubstr("scenario.random_field: a start in column 0, row 0 and a stop in column 5, row 5"),
            HasSubstr("are cut off")));
  FieldRanges many = ranges;
  many.any_start = false;
  many.sensors = {1, 31};
  EXPECT_THAT(ErrorOf([&] { UavFields(scenario, many, kMasks); }), HasSubstr("31 sensors are too many"));
  FieldRanges short_of_time = {{1, 2}, {1, 1}, {30, 75}, {9, 30}, true, true};
  EXPECT_THAT(ErrorOf([&] { UavFields(TownScenario(), short_of_time, kMasks); }),
              AllOf(HasSubstr("scenario.random_field.slots: 9"), HasSubstr("10 moves")));
}

TEST(UavFieldsWithAMap, SetOutForCellsThatFlightsLeadTo) {
  const UavFields fields = TownFields();
  const UavWorld world(TownScenario(), kMasks);
  std::set<int> places;
  RandomStream stream = TestStream(45, 0);
  for (int i = 0; i < 1000; ++i) {
    places.insert(fields.DrawPlace(stream));
    places.insert(world.DrawPlace(stream));
  }
  EXPECT_EQ(places.size(), world.map()->CellsAround({0, 0}).size());
  std::vector<float> state(static_cast<size_t>(fields.state_size()));
  state[kColumnField] = 3;
  state[kRowField] = 3;
  const Cell goal = {0, 5};
  const ActionRange range = fields.Towards(state, world.CellIndex(goal));
  EXPECT_EQ(range.first, static_cast<int>(Move::kNorth) * 5);  // west is a house
  EXPECT_EQ(range.end, range.first + 5);
  EXPECT_EQ(world.Towards(std::span(state).first(5), world.CellIndex(goal)).first,
            static_cast<int>(Move::kNorth) * 2);
}

}  // namespace
}  // namespace fresco
