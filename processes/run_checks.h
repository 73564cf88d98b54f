// Checks a run before anything is written or started, so that wrong use leaves no folder, file or process
// behind. These functions change nothing; any thread may call them.
#pragma once

#include <filesystem>

#include "bus/open_bus.h"
#include "msgs/experiment.h"
#include "storage/run_folder.h"

namespace fresco {

/// Throws UsageError if a program of the run is missing, or if this host has too little memory for the
/// learner or the local actors, alone or together. Further checks of an experiment that are possible before
/// it runs belong here.
void CheckRun(const Experiment& experiment);

/// Does CheckRun, and opens and closes the bus of the experiment. For commands with many runs. Throws as
/// CheckRun and OpenBus do.
void CheckRunAndBus(const Experiment& experiment, const BusOptions& bus_options);

/// Throws UsageError if the folder of a run can't be written to or, for a new run, holds another run.
void CheckRunFolder(const std::filesystem::path& folder, RunFolder::Use use);

}  // namespace fresco
