// One round of a soak: a run from its beginning to its end, under faults or undisturbed, resumed whenever
// its learner was killed. Used by one thread.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bus/authentication_key.h"
#include "msgs/experiment.h"
#include "soak/fault_injector.h"
#include "soak/fault_plan.h"
#include "soak/soak_checks.h"

namespace fresco {

struct RoundOptions {
  Experiment experiment;
  std::filesystem::path folder;        ///< the run's
  std::optional<FaultPlan> plan = {};  ///< none: undisturbed
  double faults_s = 0;                 ///< no fault after so long, so that the round comes to its end
  double limit_s = 0;                  ///< given up after so long
  KeyFile key_file = {};               ///< of every process
};

struct RoundResult {
  std::optional<RunFacts> facts;  ///< none: it did not come to its end
  double wall_s = 0;
  double longest_pause_s = 0;  ///< in which the learner reported nothing new
  int resumptions = 0;
  std::vector<InjectedFault> faults;
  UseByProgram use;
  std::vector<std::string> failures;
};

/// Called about twenty times a second with the learner's last status (null before the first) and how many
/// faults there were.
using RoundProgress = std::function<void(const learner_status_t*, size_t faults)>;

/// Runs it; no process of it is left afterwards. Ends without facts and without a failure where the program
/// is asked to stop.
RoundResult RunRound(const RoundOptions& options, const RoundProgress& show);

}  // namespace fresco
