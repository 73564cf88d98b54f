#include "processes/run_checks.h"

#include "core/installation.h"
#include "core/output_folder.h"

namespace fresco {

void CheckRun(const Experiment& experiment) {
  SiblingProgram("fresco-learner");
  if (experiment.run().actors() > 0) {
    SiblingProgram("fresco-actor");
  }
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
