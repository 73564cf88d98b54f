// What is checked of a run before anything is written or started, so that wrong use leaves nothing behind: no
// folder, no file, no process. The functions only look.
#pragma once

#include <filesystem>

#include "bus/open_bus.h"
#include "msgs/experiment.h"
#include "storage/run_folder.h"

namespace fresco {

/// The programs that a run is made of are there, and this host has the memory for its learner and its local
/// actors, each alone and all together. Whatever else can be said of an experiment before it runs belongs
/// here. Throws UsageError.
void CheckRun(const Experiment& experiment);

/// For commands with many runs: CheckRun, and also that the bus of the runs can be opened. It is closed
/// again. Throws as OpenBus does.
void CheckRunAndBus(const Experiment& experiment, const BusOptions& bus_options);

/// The folder of a run can be written to and, for a new run, holds no other. Throws UsageError.
void CheckRunFolder(const std::filesystem::path& folder, RunFolder::Use use);

}  // namespace fresco
