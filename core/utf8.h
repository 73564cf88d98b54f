// Texts in UTF-8 for terminals and pictures. Pure functions; any thread may call them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace fresco {

/// Returns the length of the UTF-8 sequence at the beginning of `text`; 0 if it is not valid or XML does not
/// allow it.
size_t Utf8Length(std::string_view text);

/// The number of characters of a text; a byte that is not UTF-8 counts as one.
size_t CharacterCount(std::string_view text);

/// The first `characters` characters of a text.
std::string_view FirstCharacters(std::string_view text, size_t characters);

/// A text from outside, for a terminal, JSON or a page: control characters become spaces, bytes that are not
/// UTF-8 become U+FFFD.
std::string Printable(std::string_view text);

}  // namespace fresco
