// All flights of a tiny scenario, tried one move and one transmission at a time: what the exact planner
// and its parts are held against. Written from docs/paper.md; shares nothing with worlds/uav/ but plain
// structs.
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

}  // namespace fresco
