// What a bus that hears all channels did not hand out, in words.
#pragma once

#include <string>

#include "bus/bus.h"

namespace fresco {

/// For example ", 3 packets LOST, 2 packets REFUSED, 1 messages INCOMPLETE"; empty if there was nothing.
std::string BusLossText(const Bus& bus);

/// Says on standard error what was lost, why, and what to do.
void WarnOfBusLosses(const Bus& bus);

}  // namespace fresco
