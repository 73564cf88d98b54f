// A flight as the messages that `fresco fly` publishes, one a slot. Pure.
#pragma once

#include <string>
#include <vector>

#include "msgs/wire.h"
#include "worlds/uav/flight.h"

namespace fresco {

/// One message for each slot of the flight, the terminal state included; without identity, and of flight 0.
/// The name of the policy is cut to kMaximumPolicyBytes.
std::vector<flight_t> FlightMessages(const World& world, const Flight& flight, const std::string& policy);

}  // namespace fresco
