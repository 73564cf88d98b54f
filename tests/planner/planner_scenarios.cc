#include "tests/planner/planner_scenarios.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "tests/worlds/literal_model.h"
#include "tests/worlds/table_one.h"
#include "tests/worlds/test_scenarios.h"

namespace fresco {
namespace {

double Flying(const Scenario& scenario) {
  return LiteralPower(scenario.rotor, scenario.speed_mps) * scenario.slot_s;
}

double Hovering(const Scenario& scenario) {
  return LiteralPower(scenario.rotor, 0) * scenario.slot_s;
}

void SetWeights(Scenario* scenario, RandomStream* stream) {
  constexpr double kWeights[] = {0, 0.25, 0.5, 1, 1, 1, 2, 3};
  const bool equal = Between(stream, 0, 1) == 0;
  for (Sensor& sensor : scenario->sensors) {
    sensor.weight = equal ? 1 : kWeights[Between(stream, 0, 7)];
  }
  scenario->sensors[0].weight = std::max(0.25, scenario->sensors[0].weight);
}

// Enough for the least number of dear slots and some more, half a dear slot's extra away from any limit.
void SetEnergy(Scenario* scenario, int distance, RandomStream* stream) {
  const int moves = scenario->slots - 1;
  const double flying_j = Flying(*scenario);
  const double hovering_j = Hovering(*scenario);
  const bool single_cell = scenario->columns * scenario->rows == 1;
  const int least = flying_j > hovering_j ? distance : single_cell ? moves : (moves - distance) % 2;
  const bool binds = Between(stream, 0, 1) == 0;
  const int dear = binds ? std::min(moves, least + Between(stream, 0, 4)) : moves;
  const double extra_j = std::abs(hovering_j - flying_j);
  scenario->initial_energy_j = moves * std::min(flying_j, hovering_j) + (dear + 0.5) * extra_j;
}

}  // namespace

Scenario TinyScenario(uint32_t index) {
  RandomStream stream = TestStream(20, index);
  Scenario scenario = TableOne();
  scenario.columns = Between(&stream, 1, 4);
  scenario.rows = Between(&stream, 1, 3);
  scenario.start = {Between(&stream, 0, scenario.columns - 1), Between(&stream, 0, scenario.rows - 1)};
  scenario.stop = {Between(&stream, 0, scenario.columns - 1), Between(&stream, 0, scenario.rows - 1)};
  const int sensors = Between(&stream, 1, 3);
  const int distance = std::abs(scenario.start.column - scenario.stop.column) +
                       std::abs(scenario.start.row - scenario.stop.row);
  const int most_slots = sensors == 3 ? 8 : 10;
  const int most_slack = std::min(Between(&stream, 0, 7), most_slots - 1 - distance);
  scenario.slots = std::max(2, distance + 1 + most_slack);
  scenario.sensors =
      RandomSensors(scenario.columns, scenario.rows, scenario.cell_m, sensors, 1000 + uint64_t{index});
  scenario.coverage_radius_m = 70 * stream.NextUniform();
  scenario.rotor = Between(&stream, 0, 1) == 0 ? TableOne().rotor : LiteratureRotor();
  if (Between(&stream, 0, 2) == 0) {
    scenario.maximum_aoi = Between(&stream, 1, scenario.slots + 1);
  }
  SetWeights(&scenario, &stream);
  SetEnergy(&scenario, distance, &stream);
  return scenario;
}

bool EnergyBinds(const Scenario& scenario) {
  const double dearest_j = std::max(Flying(scenario), Hovering(scenario));
  return scenario.initial_energy_j < (scenario.slots - 1) * dearest_j;
}

bool HoveringIsDearer(const Scenario& scenario) {
  return Hovering(scenario) > Flying(scenario);
}

}  // namespace fresco
