// The paper's Table I once more, for tests.
#pragma once

#include <utility>
#include <vector>

#include "worlds/uav/scenario.h"

namespace fresco {

/// Table I without sensors.
inline Scenario TableOne() {
  Scenario scenario;
  scenario.columns = scenario.rows = 20;
  scenario.cell_m = 25;
  scenario.slots = 70;
  scenario.slot_s = 1;
  scenario.start = {10, 0};
  scenario.stop = {10, 19};
  scenario.coverage_radius_m = 100;
  scenario.initial_energy_j = 22000;
  scenario.radio = {1e6, 5e6, -100, -60, 120};
  scenario.rotor = {99.66, 120.16, 120, 0.002, 0.48, 1.225, 0.0001, 0.5};
  scenario.speed_mps = 25;
  scenario.reward = {1, 1, 1};
  return scenario;
}

/// Table I over a square of `side` x `side` cells.
inline Scenario SquareField(int side, int slots, Cell start, Cell stop, std::vector<Sensor> sensors,
                            double radius_m = 100) {
  Scenario scenario = TableOne();
  scenario.columns = scenario.rows = side;
  scenario.slots = slots;
  scenario.start = start;
  scenario.stop = stop;
  scenario.sensors = std::move(sensors);
  scenario.coverage_radius_m = radius_m;
  return scenario;
}

}  // namespace fresco
