// What the generator says of the messages, against the .lcm files read in another way and against LCM's own
// encodings.
#include "fresco/message_descriptions.hpp"

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
void ExpectTheFieldsOfTheFile(const Message& message) {
  EXPECT_EQ(FieldsVisited(message), FieldsInFile(Message::getTypeName()));
}

TEST(ForEachField, VisitsTheFieldsOfEveryTypeInTheOrderOfItsFile) {
  ForEachMessageType([](const auto& message) { ExpectTheFieldsOfTheFile(message); });
  ExpectTheFieldsOfTheFile(order_t{});
  ExpectTheFieldsOfTheFile(chunk_range_t{});
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

TEST(ForEachField, HandsOutAsManyBytesAsLcmEncodes) {
  RandomStream stream(6, RandomPurpose::kTest, 0, 0);
  for (int i = 0; i < 10; ++i) {
    ForEachMessageType([&]<class Message>(const Message&) { ExpectSize<Message>(stream); });
  }
}

TEST(Description, KnowsTheBytesBeforeTheFirstTextOrArray) {
  ForEachMessageType([]<class Message>(const Message& empty) {
    constexpr size_t kEmptyTexts = Description<Message>::kTexts * (sizeof(int32_t) + 1);
    EXPECT_EQ(Description<Message>::kFixedBytes + kEmptyTexts, static_cast<size_t>(empty.getEncodedSize()))
        << Message::getTypeName();
  });
}

TEST(Description, KnowsWhereLcmWritesAField) {
  learner_status_t message{};
  message.optimum_proved = 0x5A;
  message.reordered_episodes = 0x0123456789ABCDEF;
  const std::vector<std::byte> bytes = Encoded(message);
  EXPECT_EQ(bytes[Description<learner_status_t>::optimum_proved_offset], std::byte{0x5A});
  EXPECT_EQ(ReadBigEndian<uint64_t>(&bytes[Description<learner_status_t>::reordered_episodes_offset]),
            0x0123456789ABCDEFu);
}

TEST(Description, KnowsTheBytesOfAMessageByItsCounts) {
  RandomStream stream(7, RandomPurpose::kTest, 0, 0);
  for (int i = 0; i < 10; ++i) {
    const auto message = RandomMessage<transitions_t>(stream);
    EXPECT_EQ(Description<transitions_t>::EncodedBytes(
                  static_cast<size_t>(message.transition_count), static_cast<size_t>(message.state_count),
                  static_cast<size_t>(message.field_count), static_cast<size_t>(message.mask_size)),
              static_cast<size_t>(message.getEncodedSize()));
  }
}

}  // namespace
}  // namespace fresco
