// Turns messages into what people and other programs read: rows of tables and lines of JSON, in the same way
// for both. Identifiers become hexadecimal digits, as in summary.json. Numbers get the fewest digits that
// read back as the same bits. Pure functions; any thread may call them.
#pragma once

#include <concepts>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bus/bus.h"
#include "core/csv.h"
#include "msgs/message_decoder.h"
#include "msgs/wire.h"

namespace fresco {

/// A row of a table with the names of its columns.
using NamedRow = std::vector<std::pair<std::string, CsvCell>>;

/// Return the cell for a field's value. The field's name decides whether an integer is an identifier.
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

/// Return all fields of a status except its lists.
NamedRow StatusRow(const actor_status_t& status);
NamedRow StatusRow(const learner_status_t& status);

/// Calls `handle` with a row for every transition: run, order, actor, number of the transition, outcome, s,
/// a, r, the temporal-difference error, s' and the actions allowed in s'. Returns false, without a row, if
/// the message's counts contradict each other.
bool ForEachTransitionRow(const transitions_t& message, const std::function<void(const NamedRow&)>& handle);

/// Returns a row as a JSON object in one line, without a line feed. NaN becomes null.
std::string RowJson(const NamedRow& row);

/// Returns the first eight bytes of a message, which tell its type, as hexadecimal digits.
std::string FingerprintText(std::span<const std::byte> message);

/// Returns an event as the JSON object {"utime", "channel", "type", "message": {every field}} in one line,
/// without a line feed. If the message is damaged or not Fresco's (then the type is null), the object has the
/// message's size in bytes and its first eight bytes instead of its fields.
std::string EventJson(const LcmEvent& event, MessageDecoder& decoder);

}  // namespace fresco
