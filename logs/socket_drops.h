// What the kernel has lost for want of room in this program's receive buffers: the loss that no program sees.
#pragma once

#include <cstdint>

namespace fresco {

/// Datagrams dropped so far by all UDP sockets that this program has open (Linux: /proc/self/net/udp); 0
/// where that can't be read.
int64_t DroppedDatagrams();

}  // namespace fresco
