#include "report/report_text.h"

#include <fmt/format.h>

#include "core/error.h"

namespace fresco {

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

}  // namespace fresco
