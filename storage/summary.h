// Makes summary.json, the results of a run. Pure functions; any thread may call them.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "msgs/experiment.h"
#include "planner/planner.h"
#include "storage/optimum_search.h"
#include "training/trainer.h"

namespace fresco {

/// Counts what happened to the learner's messages. The counters are in `bus` of summary.json, in the
/// learner's status and in checkpoints.
struct BusCounters {
  int64_t received = 0;                  ///< messages of this run that were received
  int64_t lost = 0;                      ///< orders whose result had to be asked for again
  int64_t duplicate = 0;                 ///< messages of transitions that brought nothing new
  int64_t rejected = 0;                  ///< sum of the five counters below
  int64_t rejected_malformed = 0;        ///< messages that do not decode or have values out of range
  int64_t rejected_foreign = 0;          ///< of another run or configuration, or of an order never written
  int64_t rejected_inconsistent = 0;     ///< results whose episode does not follow from its actions
  int64_t rejected_arithmetic = 0;       ///< statuses of actors whose arithmetic differs
  int64_t rejected_unauthenticated = 0;  ///< messages made with another key, or with none
  int64_t reordered_episodes = 0;        ///< episodes that were complete before an earlier one
  int64_t stale_statuses = 0;            ///< statuses that are not newer than the actor's last one
  int64_t crowded_statuses = 0;          ///< statuses of actors beyond Roster::kMaximumActors
  int64_t weights_chunks_sent = 0;       ///< chunks of networks sent
  int64_t weights_chunks_repeated = 0;   ///< those of them that were sent again because an actor asked
};

/// The counters by name.
std::map<std::string, int64_t> ToMap(const BusCounters& counters);

/// Ignores names that are no counter's. Counters that the map does not name are 0.
BusCounters FromMap(const std::map<std::string, int64_t>& map);

/// The number of checkpoints that this process took, and the longest pause of the training for one of them.
struct CheckpointFigures {
  int64_t taken = 0;
  int64_t longest_pause_us = 0;
};

/// What this process did from its first update to the end of the training: how long it took, how many updates
/// it made, and the processor time of the training thread and of all threads of the learner.
struct UpdatingFigures {
  int64_t wall_us = 0;
  int64_t updates = 0;
  int64_t training_thread_us = 0;
  int64_t learner_us = 0;
};

/// Processor time by role, of this process since it began, and of all actors while they were heard.
struct ProcessorFigures {
  int64_t learner_us = 0;          ///< all threads of the learner
  int64_t training_thread_us = 0;  ///< one of them
  int64_t actors_us = 0;
};

/// Everything that a summary is made of.
struct SummaryInputs {
  const Experiment& experiment;
  int64_t run_id;
  bool completed;  ///< false: the training was interrupted
  double wall_s;
  const Trainer& trainer;
  BusCounters counters;
  OptimumResult optimum = {};
  int resumptions = 0;  ///< how often the run was resumed
  CheckpointFigures checkpoints = {};
  std::optional<UpdatingFigures> updating = {};    ///< none: it made no update, or is no learner
  std::optional<ProcessorFigures> processor = {};  ///< none: it is no learner
};

/// Returns the JSON object of summary.json.
///  - It has everything of JudgementJson (judgement.h), of the best evaluated version. In a world without
///  chance
///    one episode says everything. Otherwise the episodes are `evaluation_episodes` fresh ones once the
///    training is complete, before that those by which the version was chosen.
///  - `updating` has UpdatingFigures, in seconds; null if there are none. The training thread was busy for
///    training_thread_s / wall_s of the time.
///  - `processor_s` has ProcessorFigures, in seconds, and the time of the search for the optimum, which is
///  one
///    of the learner's threads; null if there are none.
///  - `optimum_search` says how the search ended (SearchEndName); only worlds with a search have it.
///  - `evaluations_optimal_...` is the mean optimal score of the episodes that every evaluation flew; only if
///    there are `judged_episodes`; null if it is not proved.
std::string SummaryJson(const SummaryInputs& inputs);

/// Whether a run with this summary is finished: its training is complete, and its search for the optimum was
/// not stopped. Returns false if the text is not a summary.
bool IsFinished(const std::string& summary_json);

}  // namespace fresco
