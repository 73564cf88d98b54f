// Every field of every message is visited, once and in its place: held against the .lcm files and the sizes
// of LCM's own encodings.
#include "msgs/message_fields.h"

#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <string>
#include <vector>

#include "msgs/message_decoder.h"
#include "tests/msgs/message_samples.h"

namespace fresco {
namespace {

/// The names of the fields in the type's .lcm file.
std::vector<std::string> FieldsInFile(const std::string& type) {
  const std::string path = FRESCO_SOURCE_DIR "/msgs/lcm/" + type + ".lcm";
  std::ifstream file(path);
  EXPECT_TRUE(file) << path;
  const std::regex field(R"(^\s+\w+\s+(\w+)(\[\w+\])*;.*)");
  std::vector<std::string> names;
  for (std::string line; std::getline(file, line);) {
    std::smatch match;
    if (std::regex_match(line, match, field)) {
      names.push_back(match[1]);
    }
  }
  return names;
}

template <class Message>
std::vector<std::string> FieldsVisited(const Message& message) {
  std::vector<std::string> names;
  ForEachField(message, [&](const char* name, const auto&) { names.emplace_back(name); });
  return names;
}

template <class Message>
void ExpectTheFieldsOfTheFile() {
  EXPECT_EQ(FieldsVisited(Message{}), FieldsInFile(Message::getTypeName()));
}

template <class... Message>
void ExpectAll(const std::tuple<Message...>*) {
  (ExpectTheFieldsOfTheFile<Message>(), ...);
}

TEST(ForEachField, VisitsTheFieldsOfEveryTypeInTheOrderOfItsFile) {
  ExpectAll(static_cast<const MessageTypes*>(nullptr));
  ExpectAll(static_cast<const std::tuple<order_t, chunk_range_t>*>(nullptr));
}

/// Bytes of a value in LCM's encoding.
template <class Value>
size_t EncodedBytes(const Value& value) {
  if constexpr (std::is_arithmetic_v<Value>) {
    return sizeof(Value);
  } else if constexpr (std::is_same_v<Value, std::string>) {
    return sizeof(int32_t) + value.size() + 1;
  } else if constexpr (requires { value.begin(); }) {
    size_t bytes = 0;
    for (const auto& element : value) {
      bytes += EncodedBytes(element);
    }
    return bytes;
  } else {
    size_t bytes = 0;
    ForEachField(value, [&](const char*, const auto& field) { bytes += EncodedBytes(field); });
    return bytes;
  }
}

template <class Message>
void ExpectSize(RandomStream& stream) {
  constexpr size_t kFingerprintBytes = 8;
  const auto message = RandomMessage<Message>(stream);
  EXPECT_EQ(kFingerprintBytes + EncodedBytes(message), static_cast<size_t>(message.getEncodedSize()));
}

template <class... Message>
void ExpectSizes(const std::tuple<Message...>*) {
  RandomStream stream(6, RandomPurpose::kTest, 0, 0);
  for (int i = 0; i < 10; ++i) {
    (ExpectSize<Message>(stream), ...);
  }
}

TEST(ForEachField, HandsOutAsManyBytesAsLcmEncodes) {
  ExpectSizes(static_cast<const MessageTypes*>(nullptr));
}

}  // namespace
}  // namespace fresco
