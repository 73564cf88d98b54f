// Worlds of code that is not Fresco's, as a configuration describes them: `plugin` and `python`. Any thread
// may call these functions.
#pragma once

#include <memory>
#include <string>

#include "msgs/proto/experiment.pb.h"
#include "worlds/world.h"

namespace fresco {

/// Set the CRC-32C of the code that this host has. Throw UsageError if the code's path is missing, can't be
/// read, or if the configuration has another CRC-32C: then another host has another build.
void CompletePlugin(proto::ExperimentConfig& config);
void CompletePython(proto::ExperimentConfig& config);

/// Throw UsageError as DescribePlugin (plugins/plugin_world.h) does.
std::shared_ptr<const World> MakePluginWorld(const proto::ExperimentConfig& config);
std::shared_ptr<const World> MakePythonWorld(const proto::ExperimentConfig& config);

/// The path of the code.
std::string PluginCode(const proto::ExperimentConfig& config);
std::string PythonCode(const proto::ExperimentConfig& config);

}  // namespace fresco
