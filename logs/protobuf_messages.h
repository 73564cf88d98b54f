// Fresco's messages as Protobuf messages, for programs that know no LCM type. Their fields are those of
// EventJson. Pure functions; any thread may call them.
//
// Descriptions and encodings are both made from the fields of the LCM types: field n of a .lcm file has
// number n. The language is proto2, so a field that was sent is never taken for one that was not.
#pragma once

#include <cstdint>
#include <string>

#include "logs/exported_messages.h"

namespace fresco {

struct ProtobufMessage {
  std::string type = {};              ///< of the LCM message, e.g. "transitions_t"
  const WorldNames* names = nullptr;  ///< whose names the states of transitions have; null: none
  int64_t sent_utime = 0;             ///< microseconds since the epoch
  std::string bytes = {};
};

/// Sets `message` unless the result is kDamaged or kForeign. Bytes of texts that are not UTF-8 become
/// replacement characters. Of a state, only fields that the names have are encoded.
MessageDecoder::Result ToProtobuf(const LcmEvent& event, MessageDecoder& decoder,
                                  const WorldNamesByRun& names, ProtobufMessage& message);

/// Returns the google.protobuf.FileDescriptorSet of such messages, encoded. The message is "fresco.TYPE". A
/// name of the world that is not one of a Protobuf field is changed as little as possible. CHECKs that `type`
/// is the name of a Fresco type with a channel of its own.
std::string FileDescriptorSetOf(const std::string& type, const WorldNames* names);

}  // namespace fresco
