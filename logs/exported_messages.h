// Turns messages into what people and other programs read: rows of tables, lines of JSON, and Protobuf
// messages (logs/protobuf_messages.h), in the same way for all. Identifiers become hexadecimal digits, as in
// summary.json. Numbers get the fewest digits that read back as the same bits. Pure functions; any thread may
// call them.
#pragma once

#include <concepts>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "bus/bus.h"
#include "core/csv.h"
#include "msgs/message_decoder.h"
#include "msgs/wire.h"
#include "msgs/world_messages.h"

namespace fresco {

/// The names of the runs' worlds, from their FRESCO_WORLD messages. Only one thread may use an object.
class WorldNamesByRun {
 public:
  /// Takes the event's message if it is one of these.
  void Add(const LcmEvent& event);
  /// Null if they are not known.
  const WorldNames* Of(int64_t run_id) const;

 private:
  static constexpr size_t kMaximumRuns = 1000;  // more than a sound log has

  MessageDecoder decoder_;
  std::map<int64_t, WorldNamesReader> by_run_;
};

/// A state of a transitions_t whose fields have the names of its world. A part of a long state does not begin
/// at field 0.
struct NamedState {
  const WorldNames* names;
  size_t first_field;
  const std::vector<float>* values;
};

/// Return each state, and the name of each action ("" if it has none). `first_field` must not be negative.
std::vector<NamedState> NamedStates(const transitions_t& message, const WorldNames& names);
std::vector<std::string> ActionNames(const transitions_t& message, const WorldNames& names);

/// Calls visit(const char* name, const auto& value) for every field of a message as it is exported: like
/// ForEachField, but lists of bytes are texts. If the names of the run's world are given, the states of
/// transitions are NamedState, and `action_name` follows the other fields.
template <class Message, class Visitor>
void ForEachExportedField(const Message& message, const WorldNames* names, Visitor&& visit) {
  ForEachField(message, [&]<class Value>(const char* name, const Value& value) {
    if constexpr (std::is_same_v<Message, transitions_t>) {
      if constexpr (std::is_same_v<Value, std::vector<std::vector<float>>>) {
        if (names != nullptr) {
          visit(name, NamedStates(message, *names));
          return;
        }
      }
    }
    if constexpr (std::is_same_v<Value, std::vector<uint8_t>>) {
      visit(name, std::string(value.begin(), value.end()));
    } else {
      visit(name, value);
    }
  });
  if constexpr (std::is_same_v<Message, transitions_t>) {
    if (names != nullptr) {
      visit("action_name", ActionNames(message, *names));
    }
  }
}

/// The names for ForEachExportedField, of a message that was decoded; null if they are not known or do not
/// fit it.
template <class Message>
const WorldNames* NamesFor(const Message& message, const WorldNamesByRun& names) {
  if constexpr (std::is_same_v<Message, transitions_t>) {
    return message.first_field >= 0 ? names.Of(message.run_id) : nullptr;
  }
  return nullptr;
}

/// A row of a table with the names of its columns.
using NamedRow = std::vector<std::pair<std::string, CsvCell>>;

/// Whether the integers of this field are identifiers.
bool IsIdentifier(std::string_view field);

/// Return the cell for a field's value.
CsvCell CellOf(std::string_view field, int64_t value);
CsvCell CellOf(std::string_view field, double value);
/// The cell holds the double whose digits are the fewest that identify the float. Rounded to float, it is the
/// value.
CsvCell CellOf(std::string_view field, float value);
CsvCell CellOf(std::string_view field, const std::string& value);
template <std::integral Integer>
CsvCell CellOf(std::string_view field, Integer value) {
  return CellOf(field, static_cast<int64_t>(value));
}

/// Calls `handle` with a row for every transition: run, order, actor, seed, number of the transition, ending,
/// s, a, r, the temporal-difference error, s' and the actions allowed in s'. `names` are those of the run's
/// world; null if they are not known, then the fields of a state have numbers. Returns false, without a row,
/// if the message's numbers contradict each other.
bool ForEachTransitionRow(const transitions_t& message, const WorldNames* names,
                          const std::function<void(const NamedRow&)>& handle);

/// Calls `handle` with the rows of the event's message: those of ForEachTransitionRow, or one row with all
/// fields of any other message, whose lists are texts in JSON. Without a row, returns kDamaged for a message
/// that does not decode or contradicts itself, and kForeign for one that is not Fresco's.
MessageDecoder::Result ForEachRow(const LcmEvent& event, MessageDecoder& decoder,
                                  const WorldNamesByRun& names,
                                  const std::function<void(const NamedRow&)>& handle);

/// Returns the text with a replacement character for each byte that is not UTF-8.
std::string Utf8Of(std::string_view text);

/// Returns a row as a JSON object in one line, without a line feed. NaN becomes null.
std::string RowJson(const NamedRow& row);

/// Returns the first eight bytes of a message, which tell its type, as hexadecimal digits.
std::string FingerprintText(std::span<const std::byte> message);

/// Returns an event as the JSON object {"utime", "channel", "type", "message": {every field}} in one line,
/// without a line feed. If the message is damaged or not Fresco's (then the type is null), the object has the
/// message's size in bytes and its first eight bytes instead of its fields. In transitions of a run whose
/// names are known, each state is an object with the names of its fields, and `action_name` names the
/// actions.
std::string EventJson(const LcmEvent& event, MessageDecoder& decoder, const WorldNamesByRun& names = {});

}  // namespace fresco
