// Makes the parts of the report page: escaped texts and data, filled templates, tables. Pure functions; any
// thread may call them.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "report/report.h"

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

/// Which columns of the table hold numbers only, perhaps with a unit.
std::vector<bool> NumericColumns(const ReportTable& table);

/// Returns the table's HTML. Columns of numbers are aligned at the right. If the table is too wide, it can be
/// scrolled.
std::string TableHtml(const ReportTable& table);

}  // namespace fresco
