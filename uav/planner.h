// The exact planner: the flight with the least average AoI that arrives in time and with the energy on
// board. The environment is deterministic, so this optimum can be computed; every result of training
// is shown beside it. Anytime: stopped early, it has a flight and a proved lower bound. Pure: no clock
// (the caller stops it), one thread, the same result always.
#pragma once

#include <cstdint>
#include <functional>

#include "uav/flight.h"

namespace fresco {

struct PlannerProgress {
  int64_t width = 0;               ///< labels a slot in the present pass
  int slot = 0;                    ///< of the present pass
  int64_t labels = 0;              ///< in that slot
  double lower_bound_average = 0;  ///< proved so far
  double best_average = 0;         ///< of the best flight so far
};

struct PlannerOptions {
  int64_t memory_bytes = int64_t{5} << 29;  ///< 2.5 GiB; beyond it the search is cut, not the machine
  /// Called now and then; false stops the search. Empty: to the end.
  std::function<bool(const PlannerProgress&)> keep_going;
};

struct Plan {
  Flight flight;  ///< the best one found; it arrives
  /// No flight has a smaller average AoI (J of the paper). The flight's own where `optimal`.
  double lower_bound_average_aoi = 0;
  /// The same on the scale of total_aoi: N T J. With equal weights no flight has a smaller total_aoi.
  double lower_bound_total_aoi = 0;
  bool optimal = false;
  int64_t labels = 0;  ///< kept in all passes
};

/// World has made sure that a flight exists.
Plan PlanOptimally(const World& world, const PlannerOptions& options = {});

}  // namespace fresco
