// Counts the datagrams that the kernel dropped because this program's receive buffers were full, which the
// program itself can't notice. Any thread may call the function.
#pragma once

#include <cstdint>

namespace fresco {

/// Returns the number of datagrams dropped so far by all open UDP sockets of this program (from
/// /proc/self/net/udp); 0 if that can't be read.
int64_t DroppedDatagrams();

}  // namespace fresco
