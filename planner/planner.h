// The exact planner: the flight with the least average AoI that arrives in time and with the energy on
// board. The environment is deterministic, so this optimum can be computed; every result of training
// is shown beside it. Anytime: stopped early, it has a flight and a proved lower bound. Pure: no clock
// (the caller stops it), one thread, the same result always.
#pragma once

#include <cstdint>
#include <functional>

#include "worlds/uav/flight.h"

namespace fresco {

/// How far the planner is; width, slot and labels are zero while it builds its tables.
struct PlannerProgress {
  int64_t width = 0;               ///< labels a slot in the present pass
  int slot = 0;                    ///< of the present pass
  int64_t labels = 0;              ///< in that slot
  double lower_bound_average = 0;  ///< no flight has a smaller one: proved by now
  double best_average = 0;         ///< of the best flight so far
};

struct PlannerOptions {
  /// 2.5 GiB. Tables and labels are made to fit; beyond it the search is cut, not the machine. (A few
  /// hundred bytes a cell, and a hundred labels a slot, are taken in any case.)
  int64_t memory_bytes = int64_t{5} << 29;
  /// Asked about every 0.1 s or more often, counted in work and not by a clock; false stops the planner,
  /// which then returns at once. Empty: to the end.
  std::function<bool(const PlannerProgress&)> keep_going = nullptr;
};

struct Plan {
  Flight flight;  ///< the best one found; it arrives

  /// Whether the search came to its end: no flight has a smaller average AoI (J of the paper).
  /// That is exact where the weights are multiples of a common fraction, as equal ones are. Otherwise
  /// the search works with weights rounded down, and no flight is better by more than the share
  /// N^2 (T + 1)^3 / 2^50 of J (5e-9 for T = 70 and N = 4), N the sensors of positive weight.
  bool optimal = false;

  /// No flight has a smaller average AoI, whatever the weights. The flight's own where `optimal` and the
  /// weights are multiples of a common fraction.
  double lower_bound_average_aoi = 0;

  /// The bound on the scale of total_aoi. Where `optimal`, the flight's own total_aoi. Otherwise, with
  /// equal weights, a whole number below which no flight's total_aoi is; and with unequal weights N T times
  /// lower_bound_average_aoi, which says nothing about total_aoi: that is not what is minimised. For the
  /// same reason another flight may have a smaller total_aoi than an optimal one where weights are unequal.
  /// Sensors of weight zero are part of total_aoi, but the planner flies as if they weren't there: they
  /// count here with the least AoI possible, 1 in every slot, and with their own where `optimal`.
  double lower_bound_total_aoi = 0;

  int64_t labels = 0;  ///< kept in all passes of the search
};

/// World has made sure that a flight exists.
Plan PlanOptimally(const World& world, const PlannerOptions& options = {});

}  // namespace fresco
