// summary.json: what a run was and what came out of it.
#pragma once

#include <cstdint>
#include <string>

#include "learner/learner_node.h"
#include "learner/trainer.h"
#include "msgs/experiment.h"

namespace fresco {

/// Everything that a summary is made of.
struct SummaryInputs {
  const Experiment& experiment;
  const World& world;
  int64_t run_id;
  bool completed;  ///< false: the run was interrupted
  double wall_s;
  const Trainer& trainer;
  BusCounters counters;
};

/// One JSON object. The policy's figures are those of the best evaluated version; `arrived` and the
/// AoI figures are null before the first evaluation.
std::string SummaryJson(const SummaryInputs& inputs);

}  // namespace fresco
