// Reports in words what a bus that receives all channels could not hand out. Call the functions on the thread
// that polls the bus; DroppedDatagrams may be called from any thread.
#pragma once

#include <cstdint>
#include <string>

#include "bus/bus.h"

namespace fresco {

/// Returns the number of datagrams that the kernel dropped so far because receive buffers of this program
/// were full, over all its open UDP sockets (from /proc/self/net/udp); 0 if that can't be read. The program
/// itself can't notice these losses.
int64_t DroppedDatagrams();

/// Returns for example ", 3 packets LOST, 2 packets REFUSED, 1 messages INCOMPLETE"; empty if nothing was
/// lost.
std::string BusLossText(const Bus& bus);

/// Logs a warning for each kind of loss: what was lost, why, and what to do.
void WarnOfBusLosses(const Bus& bus);

}  // namespace fresco
