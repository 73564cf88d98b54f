// An event of the bus or of a log as one line of JSON, its message decoded. Pure.
#pragma once

#include <string>

#include "bus/lcm_event.h"
#include "msgs/message_decoder.h"

namespace fresco {

/// {"utime", "channel", "type", "message": {every field}}; of a message that is damaged, and of one that is
/// none of Fresco's (type null), its size and the eight bytes that it begins with instead. Without a line
/// feed.
std::string EventJson(const LcmEvent& event, MessageDecoder& decoder);

}  // namespace fresco
