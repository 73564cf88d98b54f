// Many runs, a few side by side: each in a folder of its own, so that a study that was stopped goes on
// where it was. Used by one thread.
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
  std::string name;  ///< of its folder, too
  Experiment experiment;
};

/// What a run's summary says of it.
struct StudyResult {
  bool arrived = false;
  double average_aoi = 0;  ///< of the policy that the run delivers
  int64_t total_aoi = 0;
  double aoi_average_aoi = 0;  ///< of the baselines
  double distance_average_aoi = 0;
  int64_t aoi_total_aoi = 0;
  int64_t distance_total_aoi = 0;
  // Of the exact optimum; none if it is not proved.
  std::optional<double> optimal_average_aoi;
  std::optional<int64_t> optimal_total_aoi;
  std::optional<double> gap_percent;   ///< of the policy above it
  double lower_bound_average_aoi = 0;  ///< no flight has a smaller average AoI, proved in any case
  int64_t updates = 0;
  std::string weights_crc32c;
};

struct StudyOptions {
  std::filesystem::path folder;  ///< the runs go to folder/<name>
  int parallel = 1;              ///< runs side by side, each on channels of its own
  BusOptions bus = {};           ///< of every run
};

/// Checks every run before it starts the first. Runs what has no complete summary yet, from its latest
/// checkpoint where it was interrupted, and returns the results, in the order of the jobs. Shows how far it
/// is and how long it will take on standard error. Throws UsageError where a folder holds a run of another
/// configuration or none of its checkpoints can be read, and Failure where a run fails or the program is
/// asked to stop.
std::vector<StudyResult> RunStudy(const std::vector<StudyJob>& jobs, const StudyOptions& options);

}  // namespace fresco
