// Generic operations on any configuration message, by Protobuf's reflection: parse, fill in defaults, check
// ranges (the `range` option of each field), set one field by its path. Any thread may call these functions,
// but no two threads at a time on the same message.
#pragma once

#include <google/protobuf/message.h>

#include <map>
#include <string>

namespace fresco {

/// Parses Protobuf's text format. Throws UsageError "origin:line:column: problem"; for a field that does not
/// exist it suggests a similar name.
void ParseText(const std::string& text, const std::string& origin, google::protobuf::Message& message);

/// Sets every unset scalar field that has a default to it, also in the submessages that are set. Leaves
/// missing submessages missing, and an unset oneof unset.
void FillDefaults(google::protobuf::Message& message);

/// Throws UsageError if a field's value is outside its range; the error names `origin` (the file or other
/// source), the field's path, the value and the range. NaN is outside every range. `path` is the path of
/// `message` within the configuration; empty for the whole configuration.
void CheckRanges(const google::protobuf::Message& message, const std::string& origin,
                 const std::string& path = "");

/// Sets the field at a dotted path ("agent.linear.initial", "scenario.sensor[1].x_m") to the value that the
/// text holds. A repeated field takes several values, separated by commas. Throws UsageError if there is no
/// such field (the error suggests the nearest name) or if the value does not parse.
void SetField(google::protobuf::Message& message, const std::string& path, const std::string& value);

/// The values of all fields that are set, in text format, by path: {"agent.hidden_layers", "256,256"}. The
/// paths are those of SetField.
std::map<std::string, std::string> FieldValues(const google::protobuf::Message& message);

}  // namespace fresco
