// Makes summary.json and optimum.json, the results of a run. Pure functions; any thread may call them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "msgs/experiment.h"
#include "planner/planner.h"
#include "storage/bus_counters.h"
#include "storage/optimum_search.h"
#include "training/trainer.h"

namespace fresco {

/// The number of checkpoints that this process took, and the longest pause of the training for one of them.
struct CheckpointFigures {
  int64_t taken = 0;
  int64_t longest_pause_us = 0;
};

/// Everything that a summary is made of.
struct SummaryInputs {
  const Experiment& experiment;
  const World& world;
  int64_t run_id;
  bool completed;  ///< false: the training was interrupted
  double wall_s;
  const Trainer& trainer;
  BusCounters counters;
  OptimumResult optimum = {};
  int resumptions = 0;  ///< how often the run was resumed
  CheckpointFigures checkpoints = {};
};

/// Returns the JSON object of summary.json.
///  - `arrived`, `total_aoi`, `average_aoi` and `sum_aoi` are those of the best evaluated version; null
///    before the first evaluation.
///  - `optimum_search` says how the search ended (SearchEndName).
///  - `optimal_...` are the figures of the exact optimum; null if it is not proved.
///  - `gap_percent` says how far average_aoi is above the optimum; null if that is not proved or the policy
///    does not arrive.
///  - `best_found_...` are the figures of the best flight that the search found, which may be the optimum. No
///    flight has an average AoI below `lower_bound_average_aoi`. Both are null if the search has no result.
std::string SummaryJson(const SummaryInputs& inputs);

/// Whether a run with this summary is finished: its training is complete, and its search for the optimum was
/// not stopped. Returns false if the text is not a summary.
bool IsFinished(const std::string& summary_json);

/// Returns the JSON object of optimum.json: the best flight that the search found, as indices of actions, and
/// what is proved about it.
std::string OptimumJson(const World& world, const Plan& plan);

}  // namespace fresco
