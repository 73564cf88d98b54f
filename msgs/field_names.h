// Lists the field names of a configuration, so that an error can suggest the field that was probably meant.
// Pure functions; any thread may call them.
#pragma once

#include <google/protobuf/descriptor.h>

#include <string>
#include <vector>

namespace fresco {

/// The dotted path of every field that SetField can set: "agent.batch_size", "scenario.sensor[0].x_m". An
/// element of a repeated message has the index 0.
std::vector<std::string> FieldPaths(const google::protobuf::Descriptor& message);

/// The names of this message's own fields, without those of its submessages.
std::vector<std::string> FieldNames(const google::protobuf::Descriptor& message);

/// If Protobuf's error says that a message has no field of some name, returns the suggestion of a similar
/// name, for example "; did you mean slots?". Returns "" for any other error, or if no name is similar.
std::string DidYouMeanField(const std::string& protobuf_error);

}  // namespace fresco
