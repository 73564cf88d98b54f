// How texts and data go into a page: escaped for where they stand, by filling a template. Pure.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace fresco {

/// For text between tags and for attribute values in quotes.
std::string EscapedHtml(std::string_view text);

/// JSON for a <script> element: with no "<" in it, nothing in the data can end the element. (In JSON
/// "<" stands in strings only, where it may be written \u003c.)
std::string EscapedJson(std::string_view json);

/// RFC 3986: everything but the unreserved characters as %XX.
std::string PercentEncoded(std::string_view text);

/// The page with every {{name}} replaced by the part of that name, which must be there. Parts are not
/// looked at again: a text that contains {{name}} stays as it is.
std::string FilledTemplate(std::string_view page, const std::map<std::string_view, std::string>& parts);

}  // namespace fresco
