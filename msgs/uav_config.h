// The UAV's world as a configuration describes it: `scenario`, and the options of `agent` that are only for
// it. Any thread may call these functions.
#pragma once

#include <filesystem>
#include <memory>

#include "msgs/proto/experiment.pb.h"
#include "worlds/uav/uav_world.h"

namespace fresco {

/// Whether the configuration names a file with a map (`scenario.map`).
bool NamesMap(const proto::ExperimentConfig& config);
/// Replaces `scenario.map`, if the configuration has it, by the cells of this file: a path in `folder` or, if
/// it is not there, from the working directory. Throws UsageError as ReadMapFile does, or if there are cells
/// already.
void ReadMap(proto::ExperimentConfig& config, const std::filesystem::path& folder);

/// Fills in what Protobuf's field defaults can't express: submessages, and one choice of each oneof. Throws
/// UsageError if the scenario has both `sensor` and `random_sensors`, or a map that was not read.
void CompleteScenario(proto::ExperimentConfig& config);

/// Throws UsageError as UavWorld does.
std::shared_ptr<const World> MakeUavWorld(const proto::ExperimentConfig& config);

}  // namespace fresco
