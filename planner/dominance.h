// Which labels over one cell another one beats: flying on as the other one does, it never costs more.
// Both then serve a sensor in the same slot, and from there on their AoI of it are the same; until then
// their difference counts in every slot: at least until the sensor can be covered, at most as long as
// a flight below the cost limit can leave it unserved. A part of the exact planner; one thread.
#pragma once

#include <cstdint>
#include <vector>

#include "planner/planner_problem.h"
#include "planner/work_meter.h"

namespace fresco {

/// Moves from each cell until a sensor is covered.
class CoverageDistances {
 public:
  /// Incomplete, and not to be used, where the meter has stopped.
  CoverageDistances(const PlannerProblem& problem, WorkMeter& meter);

  int At(int sensor, int cell) const {
    return distances_[static_cast<size_t>(sensor) * cells_ + static_cast<size_t>(cell)];
  }

 private:
  size_t cells_;
  std::vector<int16_t> distances_;  // [sensors x cells]; the number of slots where it can't be covered
};

/// For the labels over one cell at the beginning of one slot.
class Dominance {
 public:
  Dominance(const PlannerProblem& problem, const CoverageDistances& distances, int slot, int cell);

  /// In how many slots from this one on a sensor's present AoI goes on growing, at least. (Zero where
  /// the AoI is capped: there a difference may vanish before.)
  int shortest_unserved(size_t sensor) const { return shortest_unserved_[sensor]; }

  /// The label's cost, were every sensor served as soon as it can be, but for terms that all labels
  /// share. One label beats another only where this is not larger.
  int64_t LeastCost(int64_t cost, const int16_t* aoi) const;

 private:
  const PlannerProblem* problem_;
  std::vector<int> shortest_unserved_;
};

/// The labels over one cell that were kept, laid out so that one candidate is held against many of them
/// at a time. All numbers are whole and below 2^53, so double is exact.
class Undominated {
 public:
  Undominated(size_t sensors, bool energy_binds) : energy_binds_(energy_binds), aoi_(sensors) {}

  void Clear();
  void Add(int64_t least, int dear, const int16_t* aoi);
  size_t size() const { return size_; }

  /// Whether one of the labels beats a candidate. None of them has a larger LeastCost. `gaps`: by
  /// sensor, weight x slots by which its AoI may go on growing longer than shortest_unserved.
  bool Beat(int64_t least, int dear, const int16_t* aoi, const double* gaps) const;

 private:
  bool energy_binds_;
  size_t size_ = 0;
  std::vector<double> least_;  // each up to a multiple of the lanes, those beyond size_ beating nothing
  std::vector<double> dear_;
  std::vector<std::vector<double>> aoi_;  // by sensor
};

}  // namespace fresco
