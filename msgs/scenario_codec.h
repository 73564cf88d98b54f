// A scenario as messages for those who draw it. Pure.
#pragma once

#include <vector>

#include "msgs/wire.h"
#include "worlds/uav/scenario.h"

namespace fresco {

/// As many messages as the sensors need, without their identity.
std::vector<scenario_t> ScenarioMessages(const Scenario& scenario);

}  // namespace fresco
