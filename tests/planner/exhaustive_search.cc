#include "tests/planner/exhaustive_search.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>

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
  bool single_cell = true;  // of those that flights lead to
  for (const auto& [columns, rows] : {std::pair(0, 1), {0, -1}, {1, 0}, {-1, 0}}) {
    const Cell next = {scenario->stop.column + columns, scenario->stop.row + rows};
    single_cell = single_cell && !MayFlyLiterally(*scenario, next);
  }
  const int least = flying_j > hovering_j ? distance : single_cell ? moves : (moves - distance) % 2;
  const bool binds = Between(stream, 0, 1) == 0;
  const int dear = binds ? std::min(moves, least + Between(stream, 0, 4)) : moves;
  const double extra_j = std::abs(hovering_j - flying_j);
  scenario->initial_energy_j = moves * std::min(flying_j, hovering_j) + (dear + 0.5) * extra_j;
}

}  // namespace

ExhaustiveSearch::ExhaustiveSearch(const Scenario& scenario)
    : scenario_(scenario), flying_j_(Flying(scenario)), hovering_j_(Hovering(scenario)) {}

Situation ExhaustiveSearch::Start() const {
  return {1, scenario_.start, std::vector<int>(scenario_.sensors.size(), 1), 0};
}

double ExhaustiveSearch::CostOfSlot(const Situation& situation) const {
  double cost = 0;
  for (size_t n = 0; n < situation.aoi.size(); ++n) {
    cost += scenario_.sensors[n].weight * situation.aoi[n];
  }
  return cost;
}

bool ExhaustiveSearch::Covers(Cell cell, int sensor) const {
  const Sensor& at = scenario_.sensors[static_cast<size_t>(sensor)];
  return std::hypot(cell.column * scenario_.cell_m - at.x_m, cell.row * scenario_.cell_m - at.y_m) <=
             scenario_.coverage_radius_m &&
         HasLineOfSightLiterally(scenario_, cell, at);
}

std::vector<Situation> ExhaustiveSearch::Next(const Situation& situation) const {
  const int cap = scenario_.maximum_aoi.value_or(scenario_.slots);
  std::vector<Situation> all;
  for (int served = -1; served < static_cast<int>(situation.aoi.size()); ++served) {
    if (served >= 0 && !Covers(situation.cell, served)) {
      continue;
    }
    std::vector<int> aoi = situation.aoi;
    for (int& value : aoi) {
      value = std::min(value + 1, cap);
    }
    if (served >= 0) {
      aoi[static_cast<size_t>(served)] = 1;
    }
    for (const auto& [columns, rows] : {std::pair(0, 1), {0, -1}, {1, 0}, {-1, 0}, {0, 0}}) {
      const Cell cell{situation.cell.column + columns, situation.cell.row + rows};
      if (!MayFlyLiterally(scenario_, cell)) {
        continue;  // it would stay where it is, which is hovering
      }
      all.push_back({situation.slot + 1, cell, aoi, situation.hovers + (columns == 0 && rows == 0 ? 1 : 0)});
    }
  }
  return all;
}

bool ExhaustiveSearch::Arrives(const Situation& situation) const {
  const double used_j = situation.hovers * hovering_j_ + (scenario_.slots - 1 - situation.hovers) * flying_j_;
  return situation.cell == scenario_.stop && used_j <= scenario_.initial_energy_j + 1e-6;
}

uint64_t ExhaustiveSearch::Key(const Situation& situation, int unserved, int unserved_slots) const {
  uint64_t key = 1;
  const auto append = [&](int value) { key = key * 64 + static_cast<uint64_t>(value); };
  append(situation.slot);
  append(situation.cell.column);
  append(situation.cell.row);
  append(situation.hovers);
  for (const int aoi : situation.aoi) {
    append(aoi);
  }
  // These two are small.
  return key * 64 + static_cast<uint64_t>(unserved_slots == 0 ? 0 : unserved * 16 + unserved_slots);
}

double ExhaustiveSearch::CostToGo(const Situation& situation, int unserved, int unserved_slots) {
  const double infinity = std::numeric_limits<double>::infinity();
  if (situation.slot == scenario_.slots) {
    return Arrives(situation) ? CostOfSlot(situation) : infinity;
  }
  const int home = std::abs(situation.cell.column - scenario_.stop.column) +
                   std::abs(situation.cell.row - scenario_.stop.row);
  if (home > scenario_.slots - situation.slot) {
    return infinity;
  }
  const uint64_t key = Key(situation, unserved, unserved_slots);
  if (const auto found = known_.find(key); found != known_.end()) {
    return found->second;
  }
  double least = infinity;
  for (const Situation& next : Next(situation)) {
    const bool served = next.aoi[static_cast<size_t>(unserved)] == 1 &&
                        scenario_.maximum_aoi.value_or(2) != 1;  // with a cap of 1 nobody can tell
    if (unserved_slots > 0 && served) {
      continue;
    }
    least = std::min(least, CostToGo(next, unserved, std::max(0, unserved_slots - 1)));
  }
  return known_[key] = CostOfSlot(situation) + least;
}

double ExhaustiveSearch::LeastAverageAoi() {
  double weights = 0;
  for (const Sensor& sensor : scenario_.sensors) {
    weights += sensor.weight;
  }
  return CostToGo(Start()) / weights / scenario_.slots;
}

namespace {

// Fills in everything but grid and map.
void FillTiny(uint32_t index, RandomStream& stream, Scenario& scenario) {
  const int sensors = Between(&stream, 1, 3);
  const int distance = MovesToStop(scenario);
  const int most_slots = sensors == 3 ? 8 : 10;
  const int most_slack = std::max(0, std::min(Between(&stream, 0, 7), most_slots - 1 - distance));
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
}

}  // namespace

Scenario TinyScenario(uint32_t index) {
  RandomStream stream = TestStream(20, index);
  Scenario scenario = RandomGrid(4, 3, &stream);
  FillTiny(index, stream, scenario);
  return scenario;
}

Scenario TinyMapScenario(uint32_t index) {
  RandomStream stream = TestStream(22, index);
  Scenario scenario = RandomGrid(4, 4, &stream);
  AddRandomMap(&scenario, &stream);
  FillTiny(index, stream, scenario);
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
