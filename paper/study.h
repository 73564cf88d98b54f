// Runs the many runs of a study, a few of them side by side. Each has a folder of its own, so a study that
// was stopped can be continued. Only one thread may use it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bus/open_bus.h"
#include "msgs/experiment.h"

namespace fresco {

/// One run of a study.
struct StudyJob {
  std::string name;  ///< also the name of its folder
  Experiment experiment;
};

/// What a policy reaches: the AoI over its flight, in slots.
struct PolicyResult {
  double average_aoi = 0;
  int64_t total_aoi = 0;
};

/// The result of a run, from its summary.
struct StudyResult {
  bool arrived = false;  ///< whether the run's best policy arrives
  PolicyResult dqn;      ///< the run's best policy
  PolicyResult aoi_based;
  PolicyResult distance_based;
  std::optional<PolicyResult> optimal;  ///< the exact optimum; none if it is not proved
  std::optional<double> gap_percent;    ///< how far dqn is above the optimum; none if that is not proved
  double lower_bound_average_aoi = 0;   ///< no flight has a smaller average AoI; always proved
  int64_t updates = 0;
  std::string weights_crc32c;
};

struct StudyOptions {
  std::filesystem::path folder;  ///< a run's folder is folder/<name>
  int parallel = 1;              ///< number of runs side by side, each on channels of its own
  BusOptions bus = {};           ///< for every run
};

/// Returns the result of the run in `folder` from its summary (JSON). Throws Failure if the search for its
/// optimum failed.
StudyResult ResultOf(const std::string& summary, const std::filesystem::path& folder);

/// Checks all jobs, then runs those that have no complete summary yet; a run that was interrupted continues
/// from its latest checkpoint. Returns the results in the order of the jobs. Shows progress and the time left
/// on standard error. Throws UsageError if a folder holds a run of another configuration, or if it has
/// checkpoints but none can be read. Throws Failure if a run fails or the program is asked to stop.
std::vector<StudyResult> RunStudy(const std::vector<StudyJob>& jobs, const StudyOptions& options);

}  // namespace fresco
