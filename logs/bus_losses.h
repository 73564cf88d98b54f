// Reports in words what a bus that receives all channels could not hand out. Call the functions on the thread
// that polls the bus.
#pragma once

#include <string>

#include "bus/bus.h"

namespace fresco {

/// Returns for example ", 3 packets LOST, 2 packets REFUSED, 1 messages INCOMPLETE"; empty if nothing was
/// lost.
std::string BusLossText(const Bus& bus);

/// Logs a warning for each kind of loss: what was lost, why, and what to do.
void WarnOfBusLosses(const Bus& bus);

}  // namespace fresco
