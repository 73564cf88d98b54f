#include "logs/exported_messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "core/identifier.h"
#include "msgs/message_decoder.h"
#include "worlds/uav/environment.h"
#include "worlds/uav/world.h"

namespace fresco {
namespace {

using OrderedJson = nlohmann::ordered_json;

template <class Message>
NamedRow RowOf(const Message& message) {
  NamedRow row;
  ForEachField(message, [&](const char* name, const auto& value) {
    if constexpr (requires { CellOf(name, value); }) {
      row.emplace_back(name, CellOf(name, value));
    }
  });
  return row;
}

/// The indices of the actions that a mask allows, separated by spaces.
std::string AllowedActions(const std::vector<uint8_t>& mask, int actions) {
  std::string text;
  for (int action = 0; action < actions; ++action) {
    const auto byte = static_cast<size_t>(action / 8);
    if (byte < mask.size() && (mask[byte] >> (action % 8) & 1) != 0) {
      text += fmt::format("{}{}", text.empty() ? "" : " ", action);
    }
  }
  return text;
}

void AddState(const transitions_t& message, size_t i, const std::string& prefix, NamedRow& row) {
  const auto add = [&](const std::string& name, auto value) {
    row.emplace_back(prefix + name, CellOf(name, value));
  };
  add("column", message.column[i]);
  add("row", message.row[i]);
  add("time_margin", message.time_margin[i]);
  add("energy_margin_j", message.energy_margin_j[i]);
  for (size_t sensor = 0; sensor < message.aoi[i].size(); ++sensor) {
    add(fmt::format("aoi_{}", sensor + 1), message.aoi[i][sensor]);
  }
}

void AddAction(int action, int sensors, NamedRow& row) {
  const bool exists = action >= 0 && action < kMoves * (sensors + 1);
  row.emplace_back("action", int64_t{action});
  row.emplace_back("move", exists ? MoveName(static_cast<Move>(action / (sensors + 1))) : "none");
  row.emplace_back("scheduled", int64_t{exists ? action % (sensors + 1) : 0});
}

NamedRow TransitionRow(const transitions_t& message, size_t i) {
  NamedRow row = {{"utime", message.utime},
                  {"run_id", CellOf("run_id", message.run_id)},
                  {"order_index", message.order_index},
                  {"actor_id", message.actor_id},
                  {"transition", int64_t{message.first_transition} + static_cast<int64_t>(i)}};
  const bool is_last = i + 1 == static_cast<size_t>(message.transition_count);
  const auto outcome = is_last ? static_cast<Outcome>(message.outcome) : Outcome::kFlying;
  row.emplace_back("outcome", OutcomeName(outcome));
  AddState(message, i, "", row);
  AddAction(message.action[i], message.sensor_count, row);
  row.emplace_back("reward", CellOf("reward", message.reward[i]));
  row.emplace_back("td_error", CellOf("td_error", message.td_error[i]));
  row.emplace_back("terminal", int64_t{outcome != Outcome::kFlying});
  AddState(message, i + 1, "next_", row);
  row.emplace_back("next_allowed_actions",
                   AllowedActions(message.next_mask[i], kMoves * (message.sensor_count + 1)));
  return row;
}

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

/// Returns the JSON in one line. Bytes of texts that are not UTF-8 become replacement characters.
std::string Line(const OrderedJson& json) {
  return json.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
}

}  // namespace

CsvCell CellOf(std::string_view field, int64_t value) {
  if (field == "run_id") {
    return IdentifierText(value);
  }
  if (field == "config_hash" || field == "crc32c" || field == "arithmetic_fingerprint") {
    return fmt::format("{:08x}", static_cast<uint64_t>(value));
  }
  return value;
}

CsvCell CellOf(std::string_view, double value) {
  return value;
}

CsvCell CellOf(std::string_view, float value) {
  const std::string digits = fmt::format("{}", value);
  double shortest = value;
  std::from_chars(digits.data(), digits.data() + digits.size(), shortest);
  return static_cast<float>(shortest) == value ? shortest : double{value};
}

CsvCell CellOf(std::string_view, const std::string& value) {
  return value;
}

NamedRow StatusRow(const actor_status_t& status) {
  return RowOf(status);
}

NamedRow StatusRow(const learner_status_t& status) {
  return RowOf(status);
}

bool ForEachTransitionRow(const transitions_t& message, const std::function<void(const NamedRow&)>& handle) {
  if (message.state_count != message.transition_count + 1 || message.outcome < 0 || message.outcome > 3) {
    return false;
  }
  for (size_t i = 0; i < static_cast<size_t>(message.transition_count); ++i) {
    handle(TransitionRow(message, i));
  }
  return true;
}

std::string RowJson(const NamedRow& row) {
  OrderedJson json = OrderedJson::object();
  for (const auto& [name, cell] : row) {
    json[name] = JsonOfCell(cell);
  }
  return Line(json);
}

std::string FingerprintText(std::span<const std::byte> message) {
  std::string digits;
  for (const std::byte byte : message.first(std::min<size_t>(message.size(), 8))) {
    digits += fmt::format("{:02x}", std::to_integer<int>(byte));
  }
  return digits;
}

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
    json["fingerprint"] = FingerprintText(event.message);
  }
  return Line(json);
}

}  // namespace fresco
