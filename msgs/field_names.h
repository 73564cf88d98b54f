// The names of a configuration's fields, for errors that name the field that was probably meant.
#pragma once

#include <google/protobuf/descriptor.h>

#include <string>
#include <vector>

namespace fresco {

/// The dotted path of every field that a setting can set: "agent.batch_size", "scenario.sensor[0].x_m".
std::vector<std::string> FieldPaths(const google::protobuf::Descriptor& message);

/// The names of the fields of this message alone.
std::vector<std::string> FieldNames(const google::protobuf::Descriptor& message);

/// "; did you mean slots?" for the text of Protobuf's error that a message has no such field; "" for every
/// other error and if no field is near.
std::string DidYouMeanField(const std::string& protobuf_error);

}  // namespace fresco
