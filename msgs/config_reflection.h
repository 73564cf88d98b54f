// What works on every configuration message alike, by Protobuf's reflection: filling in defaults,
// checking ranges (the `range` option beside each field), setting one field by its path.
#pragma once

#include <string>

#include <google/protobuf/message.h>

namespace fresco {

/// Sets every unset scalar that has a default, in every submessage that is there. A oneof that is
/// unset stays so.
void FillDefaults(google::protobuf::Message& message);

/// Throws UsageError naming `origin`, the field's path, its value and the range where a value is out
/// of its range. NaN is out of every range.
void CheckRanges(const google::protobuf::Message& message, const std::string& origin,
                 const std::string& path = "");

/// Sets the field at a dotted path ("agent.linear.initial", "scenario.sensor[1].x_m") from text; a
/// repeated field takes values separated by commas. Throws UsageError naming the path if it is unknown (with
/// the nearest one) or if the value does not parse.
void SetField(google::protobuf::Message& message, const std::string& path, const std::string& value);

}  // namespace fresco
