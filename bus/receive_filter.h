// Keeps LCM's fragments from a process. Fresco's messages are one datagram each; LCM also joins fragments
// ("LC03") to messages of up to 256 MiB, and LCM 1.3.1 writes outside its memory where a fragment's header
// lies.
#pragma once

#include <cstdint>

namespace fresco {

/// Has the kernel drop what is not a whole LCM message in one datagram ("LC02") on every socket with which
/// this process receives on the UDP port `port`, before LCM reads it. The kernel counts these with the
/// datagrams that found no room (/proc/net/udp). Again does no harm. Throws Failure where there is no such
/// socket, or the kernel refuses.
void DropFragments(uint16_t port);

}  // namespace fresco
