// What somebody may have meant who gave a name that does not exist: of a command, an option, a field, a file.
// Pure.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fresco {

/// How many characters have to be inserted, removed, replaced, or swapped with their neighbour to make `to`
/// of `from`, if no character is edited twice (optimal string alignment).
size_t EditDistance(std::string_view from, std::string_view to);

/// The candidate with the fewest edits from `name`, the first of several; none if that takes edits in more
/// than a third of the characters. A candidate that begins or ends with `name` (three characters or more) is
/// near however long it is.
std::optional<std::string> NearestName(std::string_view name, const std::vector<std::string>& candidates);

/// For the end of an error's text: "; did you mean record?", or "" if no candidate is near.
std::string DidYouMean(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace fresco
