// The exact planner computes the flight with the least average AoI that arrives in time and with the energy
// on board. This is possible because the environment is deterministic; every result of training is shown
// beside this optimum. If the planner is stopped early, it returns the best flight found so far and a proved
// lower bound. It uses no clock and no randomness and runs on the thread that calls it, so equal inputs give
// equal results.
#pragma once

#include <cstdint>
#include <functional>

#include "worlds/uav/aoi_figures.h"

namespace fresco {

/// How far the planner is. While it builds its tables, width, slot and labels are zero.
struct PlannerProgress {
  int64_t width = 0;               ///< the most labels a slot in the present pass
  int slot = 0;                    ///< that the present pass has reached
  int64_t labels = 0;              ///< labels in that slot
  double lower_bound_average = 0;  ///< proved so far: no flight has a smaller average AoI
  double best_average = 0;         ///< average AoI of the best flight so far
};

struct PlannerOptions {
  /// The memory for tables and labels; the default is 2.5 GiB. If it does not suffice, the planner proves
  /// less instead of taking more. It takes a few hundred bytes a cell and memory for a hundred labels a slot
  /// in any case.
  int64_t memory_bytes = int64_t{5} << 29;
  /// The planner calls this about every 0.1 s or more often (it counts work instead of reading a clock). If
  /// it returns false, the planner returns at once. If it is empty, the planner runs to the end.
  std::function<bool(const PlannerProgress&)> keep_going = nullptr;
};

struct Plan {
  Episode flight;  ///< the best flight found; it arrives

  /// Whether the search is complete, so that no flight has a smaller average AoI (J of the paper). This is
  /// exact if the weights are multiples of a common fraction, as equal weights are. Otherwise the search uses
  /// weights rounded down, and another flight may be better by at most the share N^2 (T + 1)^3 / 2^50 of J
  /// (5e-9 for T = 70 and N = 4), where N is the number of sensors with positive weight.
  bool optimal = false;

  /// No flight has a smaller average AoI; this holds for all weights. If `optimal` is true and the weights
  /// are multiples of a common fraction, it is the average AoI of `flight`.
  double lower_bound_average_aoi = 0;

  /// The lower bound on the scale of total_aoi:
  ///  - if `optimal`, the total_aoi of `flight`;
  ///  - otherwise, with equal weights, a whole number: no flight has a smaller total_aoi;
  ///  - otherwise N T times lower_bound_average_aoi. This proves nothing about total_aoi, since the planner
  ///    does not minimise it if the weights differ; another flight may then have a smaller total_aoi than an
  ///    optimal one.
  ///
  /// The planner ignores sensors of weight zero, but total_aoi counts them. They count here with the least
  /// AoI possible, 1 in every slot; if `optimal`, with their AoI in `flight`.
  double lower_bound_total_aoi = 0;

  int64_t labels = 0;  ///< labels kept, over all passes of the search
};

/// Whether the planner knows this kind of world: the UAV's, also with a new field in every episode.
bool CanPlan(const World& world);

/// Plans the best flight of the episode with this seed; the world's constructor has made sure that a flight
/// exists. The seed decides nothing if every episode has the same field. CHECKs that it can.
Plan PlanOptimally(const World& world, uint64_t seed, const PlannerOptions& options = {});

}  // namespace fresco
