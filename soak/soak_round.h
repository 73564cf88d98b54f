// Runs one round of a soak: one run from beginning to end, undisturbed or under faults. If the learner is
// killed, the run is resumed. Only one thread may call it at a time.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bus/authenticated_bus.h"
#include "msgs/experiment.h"
#include "soak/faults.h"
#include "soak/soak_checks.h"

namespace fresco {

struct RoundOptions {
  Experiment experiment;
  std::filesystem::path folder;        ///< folder of the run
  std::optional<FaultPlan> plan = {};  ///< none: the round is undisturbed
  double faults_s = 0;                 ///< no faults begin after this time, so that the round can end
  double limit_s = 0;                  ///< after this time the round fails
  KeyFile key_file = {};               ///< for every process
};

struct RoundResult {
  std::optional<RunFacts> facts;  ///< none if the run is not complete
  double wall_s = 0;
  double longest_pause_s = 0;  ///< longest time in which the learner reported no progress
  int resumptions = 0;         ///< how often the run was resumed
  std::vector<InjectedFault> faults;
  UseByProgram use;
  std::vector<std::string> failures;
};

/// Called about twenty times a second with the learner's last status (null before the first) and the number
/// of faults so far.
using RoundProgress = std::function<void(const learner_status_t*, size_t faults)>;

/// Runs the round. Afterwards none of its processes is left. If the program is asked to stop, the result has
/// neither facts nor failures.
RoundResult RunRound(const RoundOptions& options, const RoundProgress& show);

}  // namespace fresco
