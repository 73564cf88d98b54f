#include "tests/worlds/test_scenarios.h"

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "core/error.h"
#include "tests/worlds/table_one.h"
#include "worlds/uav/obstacle_map.h"

namespace fresco {
namespace {

bool IsValid(const Scenario& scenario) {
  try {
    UavWorld world(scenario);
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

int Between(RandomStream* stream, int low, int high) {
  return low + static_cast<int>(stream->NextBelow(static_cast<uint32_t>(high - low + 1)));
}

Scenario TableOneScenario() {
  Scenario scenario = TableOne();
  scenario.sensors = {{200, 175, 1}, {25, 100, 1}, {450, 475, 1}};
  return scenario;
}

Rotor LiteratureRotor() {
  return {79.86, 88.63, 120, 4.03, 0.6, 1.225, 0.05, 0.503};
}

Scenario RandomGrid(int most_columns, int most_rows, RandomStream* stream) {
  Scenario scenario = TableOne();
  scenario.columns = Between(stream, 1, most_columns);
  scenario.rows = Between(stream, 1, most_rows);
  for (Cell* cell : {&scenario.start, &scenario.stop}) {
    *cell = {Between(stream, 0, scenario.columns - 1), Between(stream, 0, scenario.rows - 1)};
  }
  return scenario;
}

int MovesToStop(const Scenario& scenario) {
  if (scenario.map != nullptr) {
    return scenario.map->Distance(scenario.start, scenario.stop);
  }
  return std::abs(scenario.start.column - scenario.stop.column) +
         std::abs(scenario.start.row - scenario.stop.row);
}

Scenario RandomScenario(uint32_t index) {
  RandomStream stream = TestStream(1, index);
  Scenario scenario = RandomGrid(5, 5, &stream);
  scenario.slots = std::max(2, MovesToStop(scenario) + 1 + Between(&stream, 0, 9));
  scenario.sensors =
      RandomSensors(scenario.columns, scenario.rows, scenario.cell_m, Between(&stream, 1, 4), index);
  for (Sensor& sensor : scenario.sensors) {
    sensor.weight = Between(&stream, 0, 3);
  }
  scenario.sensors[0].weight = 0.5;
  scenario.coverage_radius_m = 60 * stream.NextUniform();
  scenario.rotor = Between(&stream, 0, 1) == 0 ? TableOne().rotor : LiteratureRotor();
  scenario.reward = {stream.NextUniform(), 2 * stream.NextUniform(), 3 * stream.NextUniform()};
  if (Between(&stream, 0, 3) == 0) {
    scenario.maximum_aoi = Between(&stream, 1, scenario.slots);
  }
  do {
    scenario.initial_energy_j = scenario.slots * 300 * stream.NextUniform() + 1;
  } while (!IsValid(scenario));
  return scenario;
}

void AddRandomMap(Scenario* scenario, RandomStream* stream) {
  constexpr char kCellKinds[] = "......NNRRBBS";
  do {
    std::vector<std::string> text(static_cast<size_t>(scenario->rows));
    for (std::string& row : text) {
      for (int column = 0; column < scenario->columns; ++column) {
        row.push_back(kCellKinds[Between(stream, 0, 12)]);
      }
    }
    for (const Cell cell : {scenario->start, scenario->stop}) {
      char& kind = text[text.size() - 1 - static_cast<size_t>(cell.row)][static_cast<size_t>(cell.column)];
      kind = Between(stream, 0, 1) == 0 ? 'S' : 'R';
    }
    scenario->map = std::make_shared<ObstacleMap>(text);
  } while (MovesToStop(*scenario) == ObstacleMap::kCutOff);
}

Scenario RandomMapScenario(uint32_t index) {
  Scenario scenario = RandomScenario(index);
  RandomStream stream = TestStream(31, index);
  AddRandomMap(&scenario, &stream);
  scenario.slots = std::max(2, MovesToStop(scenario) + 1 + Between(&stream, 0, 7));
  scenario.coverage_radius_m *= 2;
  do {
    scenario.initial_energy_j = scenario.slots * 300 * stream.NextUniform() + 1;
  } while (!IsValid(scenario));
  return scenario;
}

RandomStream TestStream(uint32_t test, uint32_t index) {
  return {2026, RandomPurpose::kTest, test, index};
}

int RandomAllowed(std::span<const uint8_t> mask, RandomStream* stream) {
  int index = 0;
  do {
    index = Between(stream, 0, static_cast<int>(mask.size()) - 1);
  } while (mask[static_cast<size_t>(index)] == 0);
  return index;
}

Action RandomAction(const UavWorld& world, const UavEnvironment& environment, MaskOptions options,
                    RandomStream* stream) {
  std::vector<uint8_t> mask(static_cast<size_t>(world.actions()));
  environment.WriteMask(options, mask);
  return world.ActionAt(RandomAllowed(mask, stream));
}

std::vector<float> FieldsOf(const UavState& state) {
  std::vector<float> fields = {static_cast<float>(state.cell.column), static_cast<float>(state.cell.row),
                               static_cast<float>(state.time_margin), state.energy_margin_j};
  fields.insert(fields.end(), state.aoi.begin(), state.aoi.end());
  return fields;
}

}  // namespace fresco
