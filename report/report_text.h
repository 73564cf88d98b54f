// Escapes texts and data for an HTML page, and fills templates. Pure functions; any thread may call them.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace fresco {

/// Escapes text for use between tags and in quoted attribute values.
std::string EscapedHtml(std::string_view text);

/// Escapes JSON for use in a <script> element: writes every "<" as \u003c, so nothing in the data can end the
/// element. (In JSON, "<" occurs in strings only.)
std::string EscapedJson(std::string_view json);

/// Encodes everything except the unreserved characters of RFC 3986 as %XX.
std::string PercentEncoded(std::string_view text);

/// Returns the page with every {{name}} replaced by the part of that name; CHECKs that there is one. A
/// {{name}} inside a part is not replaced.
std::string FilledTemplate(std::string_view page, const std::map<std::string_view, std::string>& parts);

}  // namespace fresco
