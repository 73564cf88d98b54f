// summary.json: what a run was and what came out of it.
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

/// The checkpoints that this process took, and for how long the training stood still for one at most.
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
  int resumptions = 0;  ///< how often the run was gone on with
  CheckpointFigures checkpoints = {};
};

/// One JSON object. The policy's figures are those of the best evaluated version; `arrived` and the
/// AoI figures are null before the first evaluation. `optimum_search` says how the search ended
/// (SearchEndName). `optimal_…` are null unless the optimum is proved, and so is `gap_percent`, that of
/// average_aoi above the optimum; it is also null if the policy does not arrive. `best_found_…` are those of
/// the best flight that the search found, which is the optimum if that is proved. No flight has an average
/// AoI below `lower_bound_average_aoi`. Both are null without a result of the search.
std::string SummaryJson(const SummaryInputs& inputs);

/// Whether nothing of a run is left to do, by its summary's JSON: it is trained, and its search for the
/// optimum was not stopped. False for what is no summary.
bool IsFinished(const std::string& summary_json);

/// optimum.json: the best flight of the search, as indices of actions, and what is proved of it.
std::string OptimumJson(const World& world, const Plan& plan);

}  // namespace fresco
