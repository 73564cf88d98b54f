// Messages as Protobuf messages, read by Protobuf's own library with the descriptions alone.
#include "logs/protobuf_messages.h"

#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>
#include <google/protobuf/dynamic_message.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/msgs/message_samples.h"
#include "worlds/cartpole/cartpole.h"

namespace fresco {
namespace {

using nlohmann::json;
namespace pb = google::protobuf;

json JsonOfProtobuf(const pb::Message& message);

json JsonOfProtobufField(const pb::Message& message, const pb::FieldDescriptor& field, int i) {
  const pb::Reflection& reflection = *message.GetReflection();
  const bool is_list = field.is_repeated();
  switch (field.type()) {
    case pb::FieldDescriptor::TYPE_INT32:
      return is_list ? reflection.GetRepeatedInt32(message, &field, i) : reflection.GetInt32(message, &field);
    case pb::FieldDescriptor::TYPE_INT64:
      return is_list ? reflection.GetRepeatedInt64(message, &field, i) : reflection.GetInt64(message, &field);
    case pb::FieldDescriptor::TYPE_FLOAT:
      return is_list ? reflection.GetRepeatedFloat(message, &field, i) : reflection.GetFloat(message, &field);
    case pb::FieldDescriptor::TYPE_DOUBLE:
      return is_list ? reflection.GetRepeatedDouble(message, &field, i)
                     : reflection.GetDouble(message, &field);
    case pb::FieldDescriptor::TYPE_STRING:
      return is_list ? reflection.GetRepeatedString(message, &field, i)
                     : reflection.GetString(message, &field);
    case pb::FieldDescriptor::TYPE_BYTES: {
      json list = json::array();
      for (const char byte : reflection.GetRepeatedString(message, &field, i)) {
        list.push_back(static_cast<uint8_t>(byte));
      }
      return list;
    }
    default: {
      const json nested = JsonOfProtobuf(reflection.GetRepeatedMessage(message, &field, i));
      return nested.contains("value") ? nested["value"] : nested;  // a list in a list
    }
  }
}

/// As EventJson shows the message.
json JsonOfProtobuf(const pb::Message& message) {
  json result = json::object();
  for (int i = 0; i < message.GetDescriptor()->field_count(); ++i) {
    const pb::FieldDescriptor& field = *message.GetDescriptor()->field(i);
    if (!field.is_repeated()) {
      EXPECT_TRUE(message.GetReflection()->HasField(message, &field)) << field.full_name();
      result[field.name()] = JsonOfProtobufField(message, field, 0);
      continue;
    }
    json& list = result[field.name()] = json::array();
    for (int j = 0; j < message.GetReflection()->FieldSize(message, &field); ++j) {
      list.push_back(JsonOfProtobufField(message, field, j));
    }
  }
  return result;
}

/// Types made from descriptions.
class DynamicTypes {
 public:
  const pb::Descriptor* Make(const std::string& description, const std::string& type) {
    pb::FileDescriptorSet files;
    EXPECT_TRUE(files.ParseFromString(description));
    for (const auto& file : files.file()) {
      EXPECT_NE(pool_.BuildFile(file), nullptr);
    }
    return pool_.FindMessageTypeByName("fresco." + type);
  }
  json Read(const ProtobufMessage& message) {
    const pb::Descriptor* type = Make(FileDescriptorSetOf(message.type, message.names), message.type);
    const std::unique_ptr<pb::Message> dynamic(factory_.GetPrototype(type)->New());
    EXPECT_TRUE(dynamic->ParseFromString(message.bytes)) << message.type;
    EXPECT_EQ(dynamic->GetReflection()->GetUnknownFields(*dynamic).field_count(), 0);
    return JsonOfProtobuf(*dynamic);
  }

 private:
  pb::DescriptorPool pool_;
  pb::DynamicMessageFactory factory_;
};

/// Numbers with a fraction compare as the floats that they were, or as doubles.
void ExpectSame(const json& found, const json& wanted, const std::string& where) {
  if (wanted.is_number_float()) {
    const double value = found.get<double>();
    EXPECT_TRUE(value == wanted.get<double>() || value == static_cast<double>(wanted.get<float>())) << where;
  } else if (wanted.is_structured()) {
    ASSERT_EQ(found.size(), wanted.size()) << where;
    for (auto item = wanted.items().begin(); item != wanted.items().end(); ++item) {
      ExpectSame(wanted.is_array() ? found.at(std::stoul(item.key())) : found.at(item.key()), item.value(),
                 where + "." + item.key());
    }
  } else {
    EXPECT_EQ(found, wanted) << where;
  }
}

ProtobufMessage ProtobufOf(const LcmEvent& event, const WorldNamesByRun& names = {}) {
  MessageDecoder decoder;
  ProtobufMessage message;
  EXPECT_EQ(ToProtobuf(event, decoder, names, message), MessageDecoder::Result::kDecoded);
  return message;
}

TEST(ToProtobuf, HasTheFieldsOfEveryTypeAsJsonHasThem) {
  RandomStream stream(3, RandomPurpose::kTest, 0, 0);
  MessageDecoder decoder;
  ForEachMessageType([&]<class Message>(const Message&) {
    for (const Message& message :
         {RandomMessage<Message>(stream), RandomMessage<Message>(stream), LargestMessage<Message>(stream)}) {
      const auto bytes = Encoded(message);
      const LcmEvent event{0, 5, "CHANNEL", bytes};
      const ProtobufMessage protobuf = ProtobufOf(event);
      EXPECT_EQ(protobuf.type, Message::getTypeName());
      EXPECT_EQ(protobuf.sent_utime, message.utime);
      ExpectSame(DynamicTypes().Read(protobuf), json::parse(EventJson(event, decoder))["message"],
                 protobuf.type);
    }
  });
}

WorldNamesByRun NamesOfCartPole(int64_t run_id) {
  WorldNamesByRun names;
  for (world_t world : WorldMessages(CartPole(500))) {
    Stamp(world, {run_id, 7}, 1);
    const auto bytes = Encoded(world);
    names.Add({0, 4, "FRESCO_WORLD", bytes});
  }
  return names;
}

TEST(ToProtobuf, NamesFieldsAndActionsIfTheNamesAreKnown) {
  RandomStream stream(3, RandomPurpose::kTest, 1, 0);
  transitions_t message = TransitionsOf(stream, 3, 4, 2);
  Stamp(message, {0xabc, 7}, 9);
  message.first_field = 0;
  message.action = {0, 1, -1};
  const auto bytes = Encoded(message);
  const LcmEvent event{0, 5, "FRESCO_TRANSITIONS", bytes};
  const WorldNamesByRun names = NamesOfCartPole(0xabc);
  const json found = DynamicTypes().Read(ProtobufOf(event, names));
  MessageDecoder decoder;
  ExpectSame(found, json::parse(EventJson(event, decoder, names))["message"], "transitions_t");
  EXPECT_EQ(found["state"][2]["angle"].get<float>(), message.state[2][2]);
  EXPECT_EQ(found["action_name"], json({"push left", "push right", ""}));
}

TEST(ToProtobuf, LeavesOutWhatTheNamesDoNotHave) {
  RandomStream stream(3, RandomPurpose::kTest, 1, 0);
  transitions_t message = TransitionsOf(stream, 1, 4, 2);
  Stamp(message, {0xabc, 7}, 9);
  const WorldNamesByRun names = NamesOfCartPole(0xabc);
  for (const int32_t first_field : {1, 4, 18'998, 0x7fffffff, -1}) {
    message.first_field = first_field;
    const auto bytes = Encoded(message);
    const ProtobufMessage protobuf = ProtobufOf({0, 5, "C", bytes}, names);
    EXPECT_EQ(protobuf.names == nullptr, first_field < 0);
    DynamicTypes types;
    const pb::Descriptor* type =
        types.Make(FileDescriptorSetOf(protobuf.type, protobuf.names), protobuf.type);
    pb::DynamicMessageFactory factory;
    const std::unique_ptr<pb::Message> dynamic(factory.GetPrototype(type)->New());
    EXPECT_TRUE(dynamic->ParseFromString(protobuf.bytes)) << first_field;
  }
}

TEST(ToProtobuf, WritesNoTextThatIsNotUtf8) {
  RandomStream stream(3, RandomPurpose::kTest, 2, 0);
  learner_status_t status = RandomMessage<learner_status_t>(stream);
  status.warning = "caf\xe9";
  const auto bytes = Encoded(status);
  EXPECT_EQ(DynamicTypes().Read(ProtobufOf({0, 5, "C", bytes}))["warning"], "caf\xef\xbf\xbd");
}

TEST(ToProtobuf, RefusesDamagedAndForeignMessages) {
  RandomStream stream(3, RandomPurpose::kTest, 3, 0);
  auto bytes = Encoded(RandomMessage<orders_t>(stream));
  bytes.back() ^= std::byte{1};
  MessageDecoder decoder;
  ProtobufMessage message;
  EXPECT_EQ(ToProtobuf({0, 5, "C", bytes}, decoder, {}, message), MessageDecoder::Result::kDamaged);
  EXPECT_EQ(ToProtobuf({0, 5, "C", {}}, decoder, {}, message), MessageDecoder::Result::kForeign);
  EXPECT_TRUE(message.bytes.empty());
}

TEST(FileDescriptorSetOf, MakesFieldsOfAnyNames) {
  WorldNames names;
  for (const char* name : {"x y", "x_y", "1st", "", "caf\xc3\xa9", "fine", "Fine", "x y"}) {
    names.state.push_back({name, ""});
  }
  DynamicTypes types;
  const pb::Descriptor* type = types.Make(FileDescriptorSetOf("transitions_t", &names), "transitions_t");
  ASSERT_NE(type, nullptr);
  const pb::Descriptor& state = *type->FindFieldByName("state")->message_type();
  std::vector<std::string> fields;
  for (int i = 0; i < state.field_count(); ++i) {
    EXPECT_EQ(state.field(i)->number(), i + 1);
    fields.push_back(state.field(i)->name());
  }
  EXPECT_THAT(fields, testing::ElementsAre("x_y", "x_y_", "_1st", "_", "caf__", "fine", "Fine", "x_y__"));
}

}  // namespace
}  // namespace fresco
