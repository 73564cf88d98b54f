// Values of messages as people and tables want them, one meaning for JSON and CSV: identifiers in the
// hexadecimal digits of summary.json, numbers with the fewest digits that read back as the same bits. Pure.
#pragma once

#include <concepts>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/csv.h"
#include "msgs/wire.h"

namespace fresco {

/// A row of a table with the names of its columns.
using NamedRow = std::vector<std::pair<std::string, CsvCell>>;

CsvCell CellOf(std::string_view field, int64_t value);
CsvCell CellOf(std::string_view field, double value);
/// The double that is written with the float's fewest digits; read back and rounded, it is the float.
CsvCell CellOf(std::string_view field, float value);
CsvCell CellOf(std::string_view field, const std::string& value);
template <std::integral Integer>
CsvCell CellOf(std::string_view field, Integer value) {
  return CellOf(field, static_cast<int64_t>(value));
}

/// Every field of a status but its lists.
NamedRow StatusRow(const actor_status_t& status);
NamedRow StatusRow(const learner_status_t& status);

/// Calls `handle` with a row for every transition: run, order, actor, number and outcome of the episode, s,
/// a, r, the temporal-difference error, s' and the actions allowed there. False, without a row, where the
/// message's counts contradict one another.
bool ForEachTransitionRow(const transitions_t& message, const std::function<void(const NamedRow&)>& handle);

}  // namespace fresco
