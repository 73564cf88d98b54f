// Turns a scenario into messages for viewers that draw it. Pure functions; any thread may call them.
#pragma once

#include <vector>

#include "msgs/wire.h"
#include "worlds/uav/scenario.h"

namespace fresco {

/// Returns as many messages as the sensors need, at most kMaximumSensorsPerScenario in each. The caller fills
/// in `utime`, `run_id` and `config_hash`.
std::vector<scenario_t> ScenarioMessages(const Scenario& scenario);

}  // namespace fresco
