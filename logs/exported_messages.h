// Turns messages into what people and other programs read: rows of tables and lines of JSON, in the same way
// for both. Identifiers become hexadecimal digits, as in summary.json. Numbers get the fewest digits that
// read back as the same bits. Pure functions; any thread may call them.
#pragma once

#include <concepts>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
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

/// Calls `handle` with a row for every transition: run, order, actor, seed, number of the transition, ending,
/// s, a, r, the temporal-difference error, s' and the actions allowed in s'. `names` are those of the run's
/// world; null if they are not known, then the fields of a state have numbers. Returns false, without a row,
/// if the message's numbers contradict each other.
bool ForEachTransitionRow(const transitions_t& message, const WorldNames* names,
                          const std::function<void(const NamedRow&)>& handle);

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
