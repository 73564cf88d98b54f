// summary.json: what a run was and what came out of it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "learner/bus_counters.h"
#include "learner/trainer.h"
#include "msgs/experiment.h"
#include "uav/planner.h"

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
  bool completed;  ///< false: the run was interrupted
  double wall_s;
  const Trainer& trainer;
  BusCounters counters;
  std::shared_ptr<const Plan> plan;  ///< of the search for the optimum; null: none
  int resumptions = 0;               ///< how often the run was gone on with
  CheckpointFigures checkpoints = {};
};

/// One JSON object. The policy's figures are those of the best evaluated version; `arrived` and the
/// AoI figures are null before the first evaluation. `optimal_…` are null unless the optimum is proved;
/// `gap_percent` is that of average_aoi above the optimum, or above lower_bound_average_aoi where it is
/// not proved (then it is the gap at most); null where the policy does not arrive.
std::string SummaryJson(const SummaryInputs& inputs);

/// optimum.json: the best flight of the search, as indices of actions, and what is proved of it.
std::string OptimumJson(const World& world, const Plan& plan);

}  // namespace fresco
