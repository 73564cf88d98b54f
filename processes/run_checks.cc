#include "processes/run_checks.h"

#include "actors/served_run.h"
#include "core/files.h"
#include "core/installation.h"
#include "learner/learner_process.h"

namespace fresco {

void CheckRun(const Experiment& experiment) {
  SiblingProgram("fresco-learner");
  if (experiment.run().actors() > 0) {
    SiblingProgram("fresco-actor");
  }
  MemoryNeed actors = ActorMemory(experiment, experiment.run().environments_per_actor());
  actors.processes = experiment.run().actors();
  RefuseIfTooLarge({LearnerMemory(experiment), actors}, ReadAvailableMemory());
}

void CheckRunAndBus(const Experiment& experiment, const BusOptions& bus_options) {
  CheckRun(experiment);
  OpenBus(experiment.run().lcm_url(), bus_options);
}

void CheckRunFolder(const std::filesystem::path& folder, RunFolder::Use use) {
  if (use == RunFolder::Use::kNewRun) {
    RunFolder::CheckNew(folder);
  } else {
    CheckOutputFolder(folder, "--resume");
  }
}

}  // namespace fresco
