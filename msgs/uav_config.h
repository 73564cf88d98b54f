// The UAV's world as a configuration describes it: `scenario`, and the options of `agent` that are only for
// it. Any thread may call these functions.
#pragma once

#include <memory>

#include "msgs/proto/experiment.pb.h"
#include "worlds/uav/uav_world.h"

namespace fresco {

/// Fills in what Protobuf's field defaults can't express: submessages, and one choice of each oneof. Throws
/// UsageError if the scenario has both `sensor` and `random_sensors`.
void CompleteScenario(proto::ExperimentConfig& config);

/// Throws UsageError as UavWorld does.
std::shared_ptr<const World> MakeUavWorld(const proto::ExperimentConfig& config);

}  // namespace fresco
