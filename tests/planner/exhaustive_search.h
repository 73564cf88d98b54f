// All flights of a tiny scenario, tried one move and one transmission at a time: the tests hold the exact
// planner and its parts against it. Written from docs/paper.md; shares nothing with worlds/uav/ but plain
// structs. And the tiny scenarios, of every kind that the exact planner has to tell apart.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "worlds/uav/scenario.h"

namespace fresco {

/// At the beginning of a slot; `aoi` of all sensors of the scenario.
struct Situation {
  int slot = 1;
  Cell cell;
  std::vector<int> aoi;
  int hovers = 0;  // so far
};

class ExhaustiveSearch {
 public:
  /// At most 63 slots and cells a side, and 4 sensors.
  explicit ExhaustiveSearch(const Scenario& scenario);

  Situation Start() const;
  /// sum_n weight_n delta_n.
  double CostOfSlot(const Situation& situation) const;
  bool Covers(Cell cell, int sensor) const;

  /// All situations of the next slot: after every transmission (of covered sensors, or none) and every
  /// move, those included from which no flight arrives.
  std::vector<Situation> Next(const Situation& situation) const;

  /// The least sum over slots t..T of sum_n weight_n delta_{n,t} of a flight that goes on from the
  /// situation and arrives in time and energy; infinity where none does. Only flights that leave sensor
  /// `unserved` unserved in the first `unserved_slots` slots, if any.
  double CostToGo(const Situation& situation, int unserved = 0, int unserved_slots = 0);

  /// The least average AoI of all flights.
  double LeastAverageAoi();

 private:
  uint64_t Key(const Situation& situation, int unserved, int unserved_slots) const;
  bool Arrives(const Situation& situation) const;

  Scenario scenario_;
  double flying_j_;
  double hovering_j_;
  std::unordered_map<uint64_t, double> known_;
};

/// 1 x 1 to 4 x 3 cells, up to 10 slots, 1 to 3 sensors, any slack from zero on; half of them with an energy
/// that allows only some hovers (or, by the literature's rotor, only some flown slots); weights whole,
/// fractional or zero; a third with a cap on the AoI. Always valid.
Scenario TinyScenario(uint32_t index);

/// The same with a map of obstacles, up to 4 x 4 cells and 11 slots. Always valid.
Scenario TinyMapScenario(uint32_t index);

/// Whether fewer slots than the flight's can be spent on whichever of hovering and flying takes more energy.
bool EnergyBinds(const Scenario& scenario);
bool HoveringIsDearer(const Scenario& scenario);

}  // namespace fresco
