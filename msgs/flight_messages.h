// What viewers draw: the messages of a field of sensors and of a flight over it. Pure functions; any thread
// may call them.
#pragma once

#include <string>
#include <vector>

#include "msgs/wire.h"
#include "worlds/uav/flight.h"

namespace fresco {

/// Returns as many messages as the sensors of the UAV's world need, at most kMaximumSensorsPerScenario in
/// each; none for another world. The caller fills in `utime`, `run_id` and `config_hash`.
std::vector<scenario_t> ScenarioMessages(const World& world);

/// Returns one message for each slot of the flight and one for its final state. The caller fills in `utime`,
/// `run_id`, `config_hash` and `flight`. Policy names longer than kMaximumPolicyBytes are cut.
std::vector<flight_t> FlightMessages(const UavWorld& world, const Episode& flight, const std::string& policy);

}  // namespace fresco
