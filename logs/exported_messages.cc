#include "logs/exported_messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "core/identifier.h"
#include "msgs/message_decoder.h"

namespace fresco {
namespace {

using OrderedJson = nlohmann::ordered_json;

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

const char* EndingName(int ending) {
  constexpr const char* kNames[] = {"none", "terminal", "truncated"};
  return kNames[ending];
}

/// The name of a field of the state or, without names, its number.
std::string FieldName(const WorldNames* names, size_t number) {
  return names != nullptr && number < names->state.size() ? names->state[number].name
                                                          : fmt::format("state_{}", number);
}

std::string ActionName(const WorldNames* names, int16_t action) {
  const bool named = names != nullptr && action >= 0 && static_cast<size_t>(action) < names->actions.size();
  return named ? names->actions[static_cast<size_t>(action)] : std::string();
}

void AddState(const transitions_t& message, const WorldNames* names, size_t i, const std::string& prefix,
              NamedRow& row) {
  for (size_t field = 0; field < message.state[i].size(); ++field) {
    const std::string name = FieldName(names, static_cast<size_t>(message.first_field) + field);
    row.emplace_back(prefix + name, CellOf(name, message.state[i][field]));
  }
}

NamedRow TransitionRow(const transitions_t& message, const WorldNames* names, size_t i) {
  NamedRow row = {{"utime", message.utime},
                  {"run_id", CellOf("run_id", message.run_id)},
                  {"order_index", message.order_index},
                  {"actor_id", message.actor_id},
                  {"seed", message.seed},
                  {"transition", int64_t{message.first_transition} + static_cast<int64_t>(i)}};
  const bool is_last = i + 1 == static_cast<size_t>(message.transition_count);
  row.emplace_back("ending", EndingName(is_last ? message.ending : 0));
  AddState(message, names, i, "", row);
  row.emplace_back("action", int64_t{message.action[i]});
  row.emplace_back("action_name", ActionName(names, message.action[i]));
  row.emplace_back("reward", CellOf("reward", message.reward[i]));
  row.emplace_back("td_error", CellOf("td_error", message.td_error[i]));
  AddState(message, names, i + 1, "next_", row);
  const int actions = names != nullptr ? static_cast<int>(names->actions.size()) : 8 * message.mask_size;
  row.emplace_back("next_allowed_actions", AllowedActions(message.next_mask[i], actions));
  return row;
}

template <class Message>
OrderedJson JsonOf(const Message& message, const WorldNames* names = nullptr);

OrderedJson JsonOfCell(const CsvCell& cell) {
  return std::visit([](const auto& value) { return OrderedJson(value); }, cell);
}

OrderedJson JsonOfState(const NamedState& state) {
  OrderedJson json = OrderedJson::object();
  for (size_t field = 0; field < state.values->size(); ++field) {
    const std::string name = FieldName(state.names, state.first_field + field);
    json[name] = JsonOfCell(CellOf(name, (*state.values)[field]));
  }
  return json;
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
  } else if constexpr (std::is_same_v<Value, NamedState>) {
    return JsonOfState(value);
  } else {
    return JsonOf(value);
  }
}

template <class Message>
OrderedJson JsonOf(const Message& message, const WorldNames* names) {
  OrderedJson json = OrderedJson::object();
  ForEachExportedField(message, names, [&json](const char* name, const auto& value) {
    json[name] = JsonOfField(name, value);
  });
  return json;
}

/// Returns the JSON in one line. Bytes of texts that are not UTF-8 become replacement characters.
std::string Line(const OrderedJson& json) {
  return json.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
}

template <class Message>
NamedRow RowOf(const Message& message) {
  NamedRow row;
  ForEachExportedField(message, nullptr, [&row](const char* name, const auto& value) {
    if constexpr (requires { CellOf(name, value); }) {
      row.emplace_back(name, CellOf(name, value));
    } else {
      row.emplace_back(name, Line(JsonOfField(name, value)));
    }
  });
  return row;
}

}  // namespace

void WorldNamesByRun::Add(const LcmEvent& event) {
  if (BeginsAs<world_t>(event.message)) {
    decoder_.Decode(event.message, [this](const auto& message) {
      if constexpr (std::is_same_v<decltype(message), const world_t&>) {
        if (by_run_.size() < kMaximumRuns || by_run_.contains(message.run_id)) {
          by_run_[message.run_id].Add(message);
        }
      }
    });
  }
}

const WorldNames* WorldNamesByRun::Of(int64_t run_id) const {
  const auto found = by_run_.find(run_id);
  return found == by_run_.end() ? nullptr : found->second.names();
}

std::vector<NamedState> NamedStates(const transitions_t& message, const WorldNames& names) {
  std::vector<NamedState> states;
  for (const std::vector<float>& values : message.state) {
    states.push_back({&names, static_cast<size_t>(message.first_field), &values});
  }
  return states;
}

std::vector<std::string> ActionNames(const transitions_t& message, const WorldNames& names) {
  std::vector<std::string> actions;
  for (const int16_t action : message.action) {
    actions.push_back(ActionName(&names, action));
  }
  return actions;
}

bool IsIdentifier(std::string_view field) {
  return field == "run_id" || field == "config_hash" || field == "crc32c" ||
         field == "arithmetic_fingerprint";
}

CsvCell CellOf(std::string_view field, int64_t value) {
  if (!IsIdentifier(field)) {
    return value;
  }
  return field == "run_id" ? IdentifierText(value) : fmt::format("{:08x}", static_cast<uint64_t>(value));
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

bool ForEachTransitionRow(const transitions_t& message, const WorldNames* names,
                          const std::function<void(const NamedRow&)>& handle) {
  if (message.state_count != message.transition_count + 1 || message.ending < 0 || message.ending > 2 ||
      message.first_field < 0) {
    return false;
  }
  for (size_t i = 0; i < static_cast<size_t>(message.transition_count); ++i) {
    handle(TransitionRow(message, names, i));
  }
  return true;
}

MessageDecoder::Result ForEachRow(const LcmEvent& event, MessageDecoder& decoder,
                                  const WorldNamesByRun& names,
                                  const std::function<void(const NamedRow&)>& handle) {
  bool consistent = true;
  const auto result = decoder.Decode(event.message, [&]<class Message>(const Message& message) {
    if constexpr (std::is_same_v<Message, transitions_t>) {
      consistent = ForEachTransitionRow(message, names.Of(message.run_id), handle);
    } else {
      handle(RowOf(message));
    }
  });
  return consistent ? result : MessageDecoder::Result::kDamaged;
}

std::string Utf8Of(std::string_view text) {
  return OrderedJson::parse(Line(OrderedJson(text))).get<std::string>();
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

std::string EventJson(const LcmEvent& event, MessageDecoder& decoder, const WorldNamesByRun& names) {
  OrderedJson json = {{"utime", event.utime}, {"channel", event.channel}, {"type", nullptr}};
  const auto result = decoder.Decode(event.message, [&](const auto& message) {
    json["type"] = message.getTypeName();
    json["message"] = JsonOf(message, NamesFor(message, names));
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
