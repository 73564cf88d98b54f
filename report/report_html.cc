#include "report/report_html.h"

#include <fmt/format.h>

#include "core/error.h"

namespace fresco {
namespace {

/// Whether a cell counts as a number. It may have a sign before it and a unit behind it. A dash or an empty
/// cell counts, too: it stands for a missing number.
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

std::string TableCell(std::string_view tag, bool number, const std::string& text) {
  return fmt::format("<{}{}>{}</{}>", tag, number ? " class=\"number\"" : "", EscapedHtml(text),
                     tag.substr(0, 2));
}

std::string HeaderRow(const std::vector<std::string>& cells, const std::vector<bool>& numeric) {
  std::string html = "<tr>";
  for (size_t column = 0; column < cells.size(); ++column) {
    html += TableCell("th scope=\"col\"", numeric[column], cells[column]);
  }
  return html + "</tr>\n";
}

std::string Row(const std::vector<std::string>& cells, const std::vector<bool>& numeric) {
  std::string html = "<tr>";
  for (size_t column = 0; column < cells.size(); ++column) {
    html += TableCell(column == 0 ? "th scope=\"row\"" : "td", numeric[column], cells[column]);
  }
  return html + "</tr>\n";
}

}  // namespace

std::string EscapedHtml(std::string_view text) {
  std::string escaped;
  escaped.reserve(text.size());
  for (const char character : text) {
    switch (character) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += character;
    }
  }
  return escaped;
}

std::string EscapedJson(std::string_view json) {
  std::string escaped;
  escaped.reserve(json.size());
  for (const char character : json) {
    if (character == '<') {
      escaped += "\\u003c";
    } else {
      escaped += character;
    }
  }
  return escaped;
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
  const std::vector<bool> numeric = NumericColumns(table);
  // tabindex lets the keyboard scroll the table.
  std::string html = fmt::format(
      "<div class=\"table\" role=\"region\" aria-label=\"{0}\" tabindex=\"0\">\n"
      "<table>\n<caption>{0}</caption>\n",
      EscapedHtml(table.title));
  if (!table.header.empty()) {
    html += "<thead>\n" + HeaderRow(table.header, numeric) + "</thead>\n";
  }
  html += "<tbody>\n";
  for (const std::vector<std::string>& row : table.rows) {
    html += Row(row, numeric);
  }
  return html + "</tbody>\n</table>\n</div>\n";
}

}  // namespace fresco
