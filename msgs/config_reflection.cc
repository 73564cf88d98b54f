#include "msgs/config_reflection.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/text_format.h>

#include <algorithm>
#include <charconv>
#include <string_view>

#include "core/error.h"
#include "msgs/proto/options.pb.h"

namespace fresco {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::DescriptorPool;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

/// Keeps the first error that a parser reports.
class FirstError : public google::protobuf::io::ErrorCollector {
 public:
  void AddError(int line, int column, const std::string& message) override {
    if (message_.empty()) {
      message_ = message;
      position_ = fmt::format("{}:{}", line + 1, column + 1);
    }
  }
  const std::string& message() const { return message_; }
  const std::string& position() const { return position_; }  // "line:column"

 private:
  std::string message_;
  std::string position_;
};

bool IsMessage(const FieldDescriptor& field) {
  return field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE;
}

/// The dotted path of every field that SetField can set: "agent.batch_size", "scenario.sensor[0].x_m". An
/// element of a repeated message has the index 0.
std::vector<std::string> FieldPaths(const Descriptor& message) {
  std::vector<std::string> paths;
  for (int i = 0; i < message.field_count(); ++i) {
    const FieldDescriptor& field = *message.field(i);
    if (field.cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) {
      paths.push_back(field.name());
      continue;
    }
    for (const std::string& below : FieldPaths(*field.message_type())) {
      paths.push_back(field.name() + (field.is_repeated() ? "[0]." : ".") + below);
    }
  }
  return paths;
}

/// The names of this message's own fields, without those of its submessages.
std::vector<std::string> FieldNames(const Descriptor& message) {
  std::vector<std::string> names;
  for (int i = 0; i < message.field_count(); ++i) {
    names.push_back(message.field(i)->name());
  }
  return names;
}

/// Returns the quoted text that follows `before`: x of before"x". Returns "" if there is none.
std::string QuotedAfter(const std::string& before, const std::string& text) {
  const size_t found = text.find(before + "\"");
  if (found == std::string::npos) {
    return "";
  }
  const size_t begin = found + before.size() + 1;
  return text.substr(begin, text.find('"', begin) - begin);
}

/// If Protobuf's error says that a message has no field of some name, returns the suggestion of a similar
/// name, for example "; did you mean slots?". Otherwise, or if no name is similar, returns "".
std::string DidYouMeanField(const std::string& protobuf_error) {
  const std::string message_name = QuotedAfter("Message type ", protobuf_error);
  const std::string field_name = QuotedAfter(" has no field named ", protobuf_error);
  const Descriptor* message = DescriptorPool::generated_pool()->FindMessageTypeByName(message_name);
  return message == nullptr ? "" : DidYouMean(field_name, FieldNames(*message));
}

std::string JoinPath(const std::string& path, const std::string& name) {
  return path.empty() ? name : path + "." + name;
}

void FillScalar(Message& message, const FieldDescriptor& field) {
  const Reflection& reflection = *message.GetReflection();
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_INT32:
      return reflection.SetInt32(&message, &field, field.default_value_int32());
    case FieldDescriptor::CPPTYPE_INT64:
      return reflection.SetInt64(&message, &field, field.default_value_int64());
    case FieldDescriptor::CPPTYPE_UINT64:
      return reflection.SetUInt64(&message, &field, field.default_value_uint64());
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return reflection.SetDouble(&message, &field, field.default_value_double());
    case FieldDescriptor::CPPTYPE_BOOL:
      return reflection.SetBool(&message, &field, field.default_value_bool());
    case FieldDescriptor::CPPTYPE_ENUM:
      return reflection.SetEnum(&message, &field, field.default_value_enum());
    case FieldDescriptor::CPPTYPE_STRING:
      return reflection.SetString(&message, &field, field.default_value_string());
    default:
      CheckFailed(__FILE_NAME__, __LINE__, field.full_name().c_str());  // a type that no configuration uses
  }
}

/// Returns the value of a numeric field as a double, since ranges are doubles. `index` is -1 if the field is
/// not repeated.
double NumericValue(const Message& message, const FieldDescriptor& field, int index) {
  const Reflection& reflection = *message.GetReflection();
  const bool repeated = index >= 0;
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_INT32:
      return repeated ? reflection.GetRepeatedInt32(message, &field, index)
                      : reflection.GetInt32(message, &field);
    case FieldDescriptor::CPPTYPE_INT64:
      return static_cast<double>(repeated ? reflection.GetRepeatedInt64(message, &field, index)
                                          : reflection.GetInt64(message, &field));
    default:
      return repeated ? reflection.GetRepeatedDouble(message, &field, index)
                      : reflection.GetDouble(message, &field);
  }
}

void CheckRange(const Message& message, const FieldDescriptor& field, int index, const std::string& origin,
                const std::string& path) {
  const proto::Range& range = field.options().GetExtension(proto::range);
  const double value = NumericValue(message, field, index);
  if (!(value >= range.minimum() && value <= range.maximum())) {
    throw UsageError(fmt::format("{}: {}: {} is out of range; allowed: {} to {}", origin, path, value,
                                 range.minimum(), range.maximum()));
  }
}

/// The first part of a path: the field's name, and its index if the part is name[index].
struct PathPart {
  std::string name;
  int index = -1;
};

PathPart ParsePathPart(const std::string& text, const std::string& path) {
  const size_t bracket = text.find('[');
  if (bracket == std::string::npos) {
    return {text, -1};
  }
  PathPart part{text.substr(0, bracket), -1};
  const std::string_view digits = std::string_view(text).substr(bracket + 1, text.size() - bracket - 2);
  const char* end = digits.data() + digits.size();
  const auto [parsed, error] = std::from_chars(digits.data(), end, part.index);
  if (!text.ends_with(']') || error != std::errc() || parsed != end || part.index < 0) {
    throw UsageError(fmt::format("--set {}: expected name[index], found \"{}\"", path, text));
  }
  return part;
}

/// Reports that `descriptor`, a message within `configuration`, has no field of this name.
[[noreturn]] void ThrowUnknownField(const Descriptor& configuration, const Descriptor& descriptor,
                                    const std::string& name, const std::string& path) {
  throw UsageError(fmt::format("--set {}: there is no field \"{}\"; {} has: {}{}", path, name,
                               descriptor.name(), fmt::join(FieldNames(descriptor), ", "),
                               DidYouMean(path, FieldPaths(configuration))));
}

/// Parses the whole text as one value; anything after the value is an error.
void AddValue(Message& message, const FieldDescriptor& field, const std::string& path,
              const std::string& value) {
  FirstError error;
  google::protobuf::TextFormat::Parser parser;
  parser.RecordErrorsTo(&error);
  const bool quoted = field.cpp_type() == FieldDescriptor::CPPTYPE_STRING && !value.starts_with('"');
  if (IsMessage(field) ||
      !parser.ParseFieldValueFromString(quoted ? "\"" + value + "\"" : value, &field, &message)) {
    throw UsageError(fmt::format("--set {}: \"{}\" is not a value of this field ({}){}", path, value,
                                 field.cpp_type_name(),
                                 error.message().empty() ? "" : ": " + error.message()));
  }
}

void SetLeaf(Message& message, const FieldDescriptor& field, const std::string& path,
             const std::string& value) {
  message.GetReflection()->ClearField(&message, &field);
  if (!field.is_repeated()) {
    return AddValue(message, field, path, value);
  }
  for (size_t begin = 0; begin <= value.size();) {
    const size_t end = std::min(value.find(',', begin), value.size());
    AddValue(message, field, path, value.substr(begin, end - begin));
    begin = end + 1;
  }
}

/// Follows `rest`, the remaining part of `path`, from `message`, which is a part of `configuration`.
void SetFieldBelow(const Descriptor& configuration, Message& message, const std::string& rest,
                   const std::string& path, const std::string& value) {
  const size_t dot = rest.find('.');
  const PathPart part = ParsePathPart(rest.substr(0, dot), path);
  const FieldDescriptor* field = message.GetDescriptor()->FindFieldByName(part.name);
  if (field == nullptr) {
    ThrowUnknownField(configuration, *message.GetDescriptor(), part.name, path);
  }
  if (dot == std::string::npos) {
    if (part.index >= 0) {
      throw UsageError(
          fmt::format("--set {}: an index may not end a path; set the whole field \"{}\"", path, part.name));
    }
    return SetLeaf(message, *field, path, value);
  }
  const Reflection& reflection = *message.GetReflection();
  if (dot == std::string::npos || !IsMessage(*field) || field->is_repeated() != (part.index >= 0) ||
      (field->is_repeated() && part.index >= reflection.FieldSize(message, field))) {
    throw UsageError(
        fmt::format("--set {}: \"{}\" has no parts, or no such index", path, rest.substr(0, dot)));
  }
  Message* below = field->is_repeated() ? reflection.MutableRepeatedMessage(&message, field, part.index)
                                        : reflection.MutableMessage(&message, field);
  SetFieldBelow(configuration, *below, rest.substr(dot + 1), path, value);
}

}  // namespace

void ParseText(const std::string& text, const std::string& origin, Message& message) {
  FirstError error;
  google::protobuf::TextFormat::Parser parser;
  parser.RecordErrorsTo(&error);
  if (!parser.ParseFromString(text, &message)) {
    throw UsageError(fmt::format("{}:{}: {}; msgs/proto/experiment.proto explains every field{}", origin,
                                 error.position(), error.message(), DidYouMeanField(error.message())));
  }
}

void FillDefaults(Message& message) {
  const Descriptor& descriptor = *message.GetDescriptor();
  const Reflection& reflection = *message.GetReflection();
  for (int i = 0; i < descriptor.field_count(); ++i) {
    const FieldDescriptor& field = *descriptor.field(i);
    if (field.is_repeated()) {
      for (int j = 0; IsMessage(field) && j < reflection.FieldSize(message, &field); ++j) {
        FillDefaults(*reflection.MutableRepeatedMessage(&message, &field, j));
      }
    } else if (IsMessage(field)) {
      if (reflection.HasField(message, &field)) {
        FillDefaults(*reflection.MutableMessage(&message, &field));
      }
    } else if (field.has_default_value() && !reflection.HasField(message, &field)) {
      FillScalar(message, field);
    }
  }
}

void CheckRanges(const Message& message, const std::string& origin, const std::string& path) {
  const Reflection& reflection = *message.GetReflection();
  std::vector<const FieldDescriptor*> fields;
  reflection.ListFields(message, &fields);
  for (const FieldDescriptor* field : fields) {
    const int count = field->is_repeated() ? reflection.FieldSize(message, field) : 1;
    for (int i = 0; i < count; ++i) {
      const int index = field->is_repeated() ? i : -1;
      const std::string name = field->name() + (index >= 0 ? fmt::format("[{}]", index) : "");
      if (IsMessage(*field)) {
        CheckRanges(index >= 0 ? reflection.GetRepeatedMessage(message, field, index)
                               : reflection.GetMessage(message, field),
                    origin, JoinPath(path, name));
      } else if (field->options().HasExtension(proto::range)) {
        CheckRange(message, *field, index, origin, JoinPath(path, name));
      }
    }
  }
}

void SetField(Message& message, const std::string& path, const std::string& value) {
  SetFieldBelow(*message.GetDescriptor(), message, path, path, value);
}

std::map<std::string, std::string> FieldValues(const Message& message) {
  std::map<std::string, std::string> values;
  const Reflection& reflection = *message.GetReflection();
  std::vector<const FieldDescriptor*> fields;
  reflection.ListFields(message, &fields);
  for (const FieldDescriptor* field : fields) {
    const int size = field->is_repeated() ? reflection.FieldSize(message, field) : 1;
    for (int i = 0; i < size; ++i) {
      if (IsMessage(*field)) {
        const Message& below = field->is_repeated() ? reflection.GetRepeatedMessage(message, field, i)
                                                    : reflection.GetMessage(message, field);
        const std::string path = field->name() + (field->is_repeated() ? fmt::format("[{}]", i) : "");
        for (const auto& [name, value] : FieldValues(below)) {
          values[JoinPath(path, name)] = value;
        }
        if (FieldValues(below).empty()) {
          values[path] = "{}";
        }
      } else {
        std::string text;
        google::protobuf::TextFormat::PrintFieldValueToString(message, field, field->is_repeated() ? i : -1,
                                                              &text);
        std::string& value = values[field->name()];
        value += (value.empty() ? "" : ",") + text;
      }
    }
  }
  return values;
}

}  // namespace fresco
