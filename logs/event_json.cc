#include "logs/event_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <vector>

#include "logs/message_cells.h"
#include "msgs/message_peek.h"
#include "msgs/wire.h"

namespace fresco {
namespace {

using OrderedJson = nlohmann::ordered_json;

template <class Message>
OrderedJson JsonOf(const Message& message);

OrderedJson JsonOfCell(const CsvCell& cell) {
  return std::visit([](const auto& value) { return OrderedJson(value); }, cell);
}

template <class Value>
OrderedJson JsonOfField(const char* name, const Value& value) {
  if constexpr (requires { CellOf(name, value); }) {
    return JsonOfCell(CellOf(name, value));
  } else if constexpr (requires { value.begin(); }) {
    OrderedJson list = OrderedJson::array();
    for (const auto& element : value) {
      list.push_back(JsonOfField(name, element));
    }
    return list;
  } else {
    return JsonOf(value);
  }
}

template <class Message>
OrderedJson JsonOf(const Message& message) {
  OrderedJson json = OrderedJson::object();
  ForEachField(message, [&json](const char* name, const auto& value) {
    if constexpr (std::is_same_v<decltype(value), const std::vector<uint8_t>&>) {  // part of a text
      json[name] = std::string(value.begin(), value.end());
    } else {
      json[name] = JsonOfField(name, value);
    }
  });
  return json;
}

std::string FirstBytes(std::span<const std::byte> bytes) {
  std::string digits;
  for (const std::byte byte : bytes.first(std::min<size_t>(bytes.size(), 8))) {
    digits += fmt::format("{:02x}", std::to_integer<int>(byte));
  }
  return digits;
}

}  // namespace

std::string EventJson(const LcmEvent& event, MessageDecoder& decoder) {
  OrderedJson json = {{"utime", event.utime}, {"channel", event.channel}, {"type", nullptr}};
  const auto result = decoder.Decode(event.message, [&json](const auto& message) {
    json["type"] = message.getTypeName();
    json["message"] = JsonOf(message);
  });
  if (result != MessageDecoder::Result::kDecoded) {
    if (result == MessageDecoder::Result::kDamaged) {
      json["type"] = PeekType(event.message);
      json["damaged"] = true;
    }
    json["bytes"] = event.message.size();
    json["fingerprint"] = FirstBytes(event.message);
  }
  return json.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);  // texts may be no valid UTF-8
}

}  // namespace fresco
