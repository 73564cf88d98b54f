#include "logs/protobuf_messages.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.pb.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <set>
#include <tuple>
#include <type_traits>

#include "core/error.h"

namespace fresco {
namespace {

using google::protobuf::DescriptorProto;
using google::protobuf::FieldDescriptorProto;

template <class Value>
constexpr bool kIsList = false;
template <class Element>
constexpr bool kIsList<std::vector<Element>> = true;
template <>
constexpr bool kIsList<std::vector<uint8_t>> = false;

template <class Value>
constexpr bool kIsBytes = std::is_same_v<Value, std::vector<uint8_t>>;

// Descriptions.

template <class Value>
FieldDescriptorProto::Type ScalarType(const char* name) {
  if constexpr (std::is_same_v<Value, float>) {
    return FieldDescriptorProto::TYPE_FLOAT;
  } else if constexpr (std::is_same_v<Value, double>) {
    return FieldDescriptorProto::TYPE_DOUBLE;
  } else if constexpr (kIsBytes<Value>) {
    return FieldDescriptorProto::TYPE_BYTES;
  } else if constexpr (std::is_integral_v<Value>) {
    return IsIdentifier(name)                ? FieldDescriptorProto::TYPE_STRING
           : sizeof(Value) < sizeof(int64_t) ? FieldDescriptorProto::TYPE_INT32
                                             : FieldDescriptorProto::TYPE_INT64;
  } else {
    static_assert(std::is_same_v<Value, std::string>);
    return FieldDescriptorProto::TYPE_STRING;
  }
}

FieldDescriptorProto& AddField(const std::string& name, bool is_list, DescriptorProto& message) {
  FieldDescriptorProto& field = *message.add_field();
  field.set_name(name);
  field.set_number(message.field_size());
  field.set_label(is_list ? FieldDescriptorProto::LABEL_REPEATED : FieldDescriptorProto::LABEL_OPTIONAL);
  return field;
}

/// A name of a Protobuf field that `taken` does not have, and adds it there.
std::string FieldNameLike(std::string name, std::set<std::string>& taken) {
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c) || c > 127; }, '_');
  if (name.empty() || std::isdigit(static_cast<unsigned char>(name[0])) != 0) {
    name.insert(0, 1, '_');
  }
  while (!taken.insert(name).second) {
    name += '_';
  }
  return name;
}

void DescribeState(const WorldNames& names, DescriptorProto& message) {
  std::set<std::string> taken;
  for (const Quantity& quantity : names.state) {
    AddField(FieldNameLike(quantity.name, taken), false, message).set_type(FieldDescriptorProto::TYPE_FLOAT);
  }
}

template <class Message>
void Describe(const std::string& scope, const WorldNames* names, DescriptorProto& message);

/// Describes a field that is one of these values, or a list of them.
template <class Value>
void DescribeField(const char* name, bool is_list, const std::string& scope, const WorldNames* names,
                   DescriptorProto& message) {
  FieldDescriptorProto& field = AddField(name, is_list, message);
  if constexpr (std::is_arithmetic_v<Value> || std::is_same_v<Value, std::string> || kIsBytes<Value>) {
    field.set_type(ScalarType<Value>(name));
    if (is_list && std::is_arithmetic_v<Value>) {
      field.mutable_options()->set_packed(true);
    }
  } else {
    const std::string type = std::string(name) + "_t";
    field.set_type(FieldDescriptorProto::TYPE_MESSAGE);
    field.set_type_name(scope + "." + type);
    DescriptorProto& nested = *message.add_nested_type();
    nested.set_name(type);
    if constexpr (std::is_same_v<Value, NamedState>) {
      DescribeState(*names, nested);
    } else if constexpr (kIsList<Value>) {
      DescribeField<typename Value::value_type>("value", true, field.type_name(), names, nested);
    } else {
      Describe<Value>(field.type_name(), names, nested);
    }
  }
}

template <class Message>
void Describe(const std::string& scope, const WorldNames* names, DescriptorProto& message) {
  ForEachExportedField(Message{}, names, [&]<class Value>(const char* name, const Value&) {
    if constexpr (kIsList<Value>) {
      DescribeField<typename Value::value_type>(name, true, scope, names, message);
    } else {
      DescribeField<Value>(name, false, scope, names, message);
    }
  });
}

// Encodings: https://protobuf.dev/programming-guides/encoding

enum class WireType : uint64_t { kVarint = 0, kFixed64 = 1, kBytes = 2, kFixed32 = 5 };

void AppendVarint(uint64_t value, std::string& bytes) {
  for (; value > 127; value >>= 7) {
    bytes += static_cast<char>(value | 128);
  }
  bytes += static_cast<char>(value);
}

void AppendTag(int number, WireType type, std::string& bytes) {
  AppendVarint(static_cast<uint64_t>(number) << 3 | static_cast<uint64_t>(type), bytes);
}

void AppendBytes(int number, std::string_view content, std::string& bytes) {
  AppendTag(number, WireType::kBytes, bytes);
  AppendVarint(content.size(), bytes);
  bytes += content;
}

template <class Value>
constexpr WireType kWireType = std::is_integral_v<Value>       ? WireType::kVarint
                               : std::is_same_v<Value, double> ? WireType::kFixed64
                                                               : WireType::kFixed32;

template <class Value>
void AppendNumber(Value value, std::string& bytes) {
  if constexpr (std::is_integral_v<Value>) {
    AppendVarint(static_cast<uint64_t>(int64_t{value}), bytes);
  } else {
    static_assert(std::endian::native == std::endian::little);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
}

template <class Message>
std::string Encoding(const Message& message, const WorldNames* names);

std::string StateEncoding(const NamedState& state) {
  std::string bytes;
  for (size_t i = 0; i < state.values->size() && state.first_field + i < state.names->state.size(); ++i) {
    AppendTag(static_cast<int>(state.first_field + i) + 1, WireType::kFixed32, bytes);
    AppendNumber((*state.values)[i], bytes);
  }
  return bytes;
}

template <class Value>
void AppendField(int number, const char* name, const Value& value, std::string& bytes) {
  if constexpr (std::is_arithmetic_v<Value>) {
    if (IsIdentifier(name)) {
      AppendBytes(number, std::get<std::string>(CellOf(name, value)), bytes);
    } else {
      AppendTag(number, kWireType<Value>, bytes);
      AppendNumber(value, bytes);
    }
  } else if constexpr (std::is_same_v<Value, std::string>) {
    AppendBytes(number, Utf8Of(value), bytes);
  } else if constexpr (kIsBytes<Value>) {
    AppendBytes(number, {reinterpret_cast<const char*>(value.data()), value.size()}, bytes);
  } else if constexpr (std::is_same_v<Value, NamedState>) {
    AppendBytes(number, StateEncoding(value), bytes);
  } else if constexpr (kIsList<Value>) {
    using Element = typename Value::value_type;
    std::string packed;
    for (const Element& element : value) {
      if constexpr (std::is_arithmetic_v<Element>) {
        AppendNumber(element, packed);
      } else if constexpr (kIsList<Element>) {
        std::string nested;
        AppendField(1, "value", element, nested);
        AppendBytes(number, nested, bytes);
      } else {
        AppendField(number, name, element, bytes);
      }
    }
    if (!packed.empty()) {
      AppendBytes(number, packed, bytes);
    }
  } else {
    AppendBytes(number, Encoding(value, nullptr), bytes);
  }
}

template <class Message>
std::string Encoding(const Message& message, const WorldNames* names) {
  std::string bytes;
  int number = 0;
  ForEachExportedField(message, names, [&](const char* name, const auto& value) {
    AppendField(++number, name, value, bytes);
  });
  return bytes;
}

}  // namespace

MessageDecoder::Result ToProtobuf(const LcmEvent& event, MessageDecoder& decoder,
                                  const WorldNamesByRun& names, ProtobufMessage& message) {
  return decoder.Decode(event.message, [&](const auto& lcm_message) {
    const WorldNames* known = NamesFor(lcm_message, names);
    message = {lcm_message.getTypeName(), known, lcm_message.utime, Encoding(lcm_message, known)};
  });
}

std::string FileDescriptorSetOf(const std::string& type, const WorldNames* names) {
  google::protobuf::FileDescriptorSet files;
  const auto describe = [&]<class Message>(const Message&) {
    if (Message::getTypeName() == type) {
      google::protobuf::FileDescriptorProto& file = *files.add_file();
      file.set_name("fresco/" + type + ".proto");
      file.set_package("fresco");
      DescriptorProto& message = *file.add_message_type();
      message.set_name(type);
      Describe<Message>(".fresco." + type, names, message);
    }
  };
  std::apply([&](const auto&... message) { (describe(message), ...); }, MessageTypes{});
  FRESCO_CHECK(files.file_size() == 1);
  return files.SerializeAsString();
}

}  // namespace fresco
