// Turns an event of a bus or a log into one line of JSON. A pure function; any thread may call it, each with
// a decoder of its own.
#pragma once

#include <string>

#include "bus/bus.h"
#include "msgs/message_decoder.h"

namespace fresco {

/// Returns {"utime", "channel", "type", "message": {every field}}. If the message is damaged or not Fresco's
/// (then the type is null), the object has the message's size in bytes and its first eight bytes instead of
/// its fields. There is no line feed at the end.
std::string EventJson(const LcmEvent& event, MessageDecoder& decoder);

}  // namespace fresco
