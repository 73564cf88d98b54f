// What viewers draw of the UAV's world: the messages of a field of sensors and of a flight over it. Code that
// serves any world gets them from msgs/worlds.h. Pure functions; any thread may call them.
#pragma once

#include <string>
#include <vector>

#include "msgs/wire.h"
#include "worlds/uav/flight.h"

namespace fresco {

/// Returns as many messages as the sensors and the cells of the map need, at most kMaximumSensorsPerScenario
/// and kMaximumCellsPerScenario in each. The caller fills in `utime`, `run_id` and `config_hash`.
std::vector<scenario_t> ScenarioMessages(const UavWorld& world);

/// Returns one message for each slot of the flight and one for its final state. The caller fills in `utime`,
/// `run_id`, `config_hash` and `flight`. Policy names longer than kMaximumPolicyBytes are cut.
std::vector<flight_t> FlightMessages(const UavWorld& world, const Episode& flight, const std::string& policy);

}  // namespace fresco
