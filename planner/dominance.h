// Decides which labels (partial flights) over one cell beat which others. A label beats another one if it
// never costs more, provided that it continues exactly as the other one does. Both then serve a sensor in the
// same slot, and from there on their AoI of this sensor is the same. Until then the difference of their AoI
// counts in every slot: at least until the sensor can be covered, and at most as long as a flight below the
// cost limit can leave it unserved. Part of the exact planner. Only one thread may use an object.
#pragma once

#include <cstdint>
#include <vector>

#include "planner/planner_problem.h"
#include "planner/work_meter.h"

namespace fresco {

/// The number of moves from each cell to the nearest cell that covers a sensor.
class CoverageDistances {
 public:
  /// If the meter has stopped, the object is incomplete and must not be used.
  CoverageDistances(const PlannerProblem& problem, WorkMeter& meter);

  /// The distance in moves; the number of slots if no cell covers the sensor. `sensor` is an index into
  /// PlannerProblem::sensors().
  int At(int sensor, int cell) const {
    return distances_[static_cast<size_t>(sensor) * cells_ + static_cast<size_t>(cell)];
  }

 private:
  size_t cells_;
  std::vector<int16_t> distances_;  // [sensors x cells]
};

/// Compares the labels over one cell at the beginning of one slot.
class Dominance {
 public:
  Dominance(const PlannerProblem& problem, const CoverageDistances& distances, int slot, int cell);

  /// The least number of slots from this one to the one in which the sensor is served (or to the last one),
  /// both included. A difference of AoI counts in all of them. It is zero if the scenario has a maximum AoI,
  /// since a difference may vanish earlier then.
  int shortest_unserved(size_t sensor) const { return shortest_unserved_[sensor]; }

  /// The cost of a label if every sensor were served as early as possible, without the terms that all labels
  /// share. A label can beat another one only if its LeastCost is not larger. `aoi` has one entry for each
  /// sensor.
  int64_t LeastCost(int64_t cost, const int16_t* aoi) const;

 private:
  const PlannerProblem* problem_;
  std::vector<int> shortest_unserved_;
};

/// The labels over one cell that no other label beats, stored so that a candidate is compared with many of
/// them at a time. All numbers are whole and below 2^53, so doubles are exact.
class Undominated {
 public:
  Undominated(size_t sensors, bool energy_binds) : energy_binds_(energy_binds), aoi_(sensors) {}

  void Clear();
  /// Adds a label with this LeastCost, number of dear slots and AoI. Add labels in ascending order of
  /// LeastCost.
  void Add(int64_t least, int dear, const int16_t* aoi);
  size_t size() const { return size_; }

  /// Whether one of the labels beats a candidate, whose LeastCost is at least theirs. `gaps` has for each
  /// sensor its weight times the difference between OverCell::LongestUnserved and shortest_unserved.
  bool Beat(int64_t least, int dear, const int16_t* aoi, const double* gaps) const;

 private:
  bool energy_binds_;
  size_t size_ = 0;
  // Each vector's size is a multiple of the lanes; entries beyond size_ beat no candidate.
  std::vector<double> least_;
  std::vector<double> dear_;
  std::vector<std::vector<double>> aoi_;  // by sensor
};

}  // namespace fresco
