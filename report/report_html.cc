#include "report/report_html.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <utility>

#include "core/error.h"

namespace fresco {
namespace {

/// Whether a cell counts as a number. It may have a sign before it and a unit behind it. A dash or an empty
/// cell counts, too, as a missing number.
bool IsNumber(std::string_view cell) {
  constexpr std::string_view kSigns[] = {"-", "+", "\u2212", "\u2013", "\u2014", "\u00b1", "<", ">", "~"};
  for (const std::string_view sign : kSigns) {
    if (cell.starts_with(sign)) {
      cell.remove_prefix(sign.size());
      break;
    }
  }
  return cell.empty() || (cell.front() >= '0' && cell.front() <= '9');
}

/// Returns a row of the table. `first_tag` and `tag` are those of the first and the other cells.
std::string Row(const std::vector<std::string>& cells, const std::vector<bool>& numeric,
                std::string_view first_tag, std::string_view tag) {
  std::string html = "<tr>";
  for (size_t column = 0; column < cells.size(); ++column) {
    const std::string_view cell_tag = column == 0 ? first_tag : tag;
    html += fmt::format("<{}{}>{}</{}>", cell_tag, numeric[column] ? " class=\"number\"" : "",
                        EscapedHtml(cells[column]), cell_tag.substr(0, 2));
  }
  return html + "</tr>\n";
}

using Replacement = std::pair<char, std::string_view>;

std::string Replaced(std::string_view text, std::initializer_list<Replacement> replacements) {
  std::string replaced;
  replaced.reserve(text.size());
  for (const char character : text) {
    const auto found =
        std::find_if(replacements.begin(), replacements.end(),
                     [&](const Replacement& replacement) { return replacement.first == character; });
    replaced += found == replacements.end() ? std::string_view(&character, 1) : found->second;
  }
  return replaced;
}

}  // namespace

std::vector<bool> NumericColumns(const ReportTable& table) {
  const std::vector<std::string>& first =
      table.header.empty() && !table.rows.empty() ? table.rows.front() : table.header;
  std::vector<bool> numeric(first.size(), true);
  for (const std::vector<std::string>& row : table.rows) {
    FRESCO_CHECK(row.size() == numeric.size());
    for (size_t column = 0; column < row.size(); ++column) {
      numeric[column] = numeric[column] && IsNumber(row[column]);
    }
  }
  return numeric;
}

std::string EscapedHtml(std::string_view text) {
  return Replaced(text, {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&#39;"}});
}

std::string EscapedJson(std::string_view json) {
  return Replaced(json, {{'<', "\\u003c"}});
}

std::string PercentEncoded(std::string_view text) {
  constexpr std::string_view kUnreserved =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~";
  std::string encoded;
  encoded.reserve(2 * text.size());
  for (const char character : text) {
    if (kUnreserved.find(character) != std::string_view::npos) {
      encoded += character;
    } else {
      encoded += fmt::format("%{:02X}", static_cast<unsigned char>(character));
    }
  }
  return encoded;
}

std::string FilledTemplate(std::string_view page, const std::map<std::string_view, std::string>& parts) {
  std::string filled;
  size_t begin = page.find("{{");
  while (begin != std::string_view::npos) {
    const size_t end = page.find("}}", begin);
    FRESCO_CHECK(end != std::string_view::npos);
    const auto part = parts.find(page.substr(begin + 2, end - begin - 2));
    FRESCO_CHECK(part != parts.end());
    filled += page.substr(0, begin);
    filled += part->second;
    page.remove_prefix(end + 2);
    begin = page.find("{{");
  }
  filled += page;
  return filled;
}

std::string TableHtml(const ReportTable& table) {
  constexpr std::string_view kColumnHeader = "th scope=\"col\"";
  const std::vector<bool> numeric = NumericColumns(table);
  // tabindex lets the keyboard scroll the table.
  std::string html = fmt::format(
      "<div class=\"table\" role=\"region\" aria-label=\"{0}\" tabindex=\"0\">\n"
      "<table>\n<caption>{0}</caption>\n",
      EscapedHtml(table.title));
  if (!table.header.empty()) {
    html += "<thead>\n" + Row(table.header, numeric, kColumnHeader, kColumnHeader) + "</thead>\n";
  }
  html += "<tbody>\n";
  for (const std::vector<std::string>& row : table.rows) {
    html += Row(row, numeric, "th scope=\"row\"", "td");
  }
  return html + "</tbody>\n</table>\n</div>\n";
}

}  // namespace fresco
