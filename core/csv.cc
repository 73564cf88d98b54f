#include "core/csv.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/files.h"

namespace fresco {
namespace {

std::string Quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) {
    return text;
  }
  std::string quoted = "\"";
  for (const char character : text) {
    quoted += character;
    if (character == '"') {
      quoted += '"';
    }
  }
  quoted += '"';
  return quoted;
}

std::string CellText(const CsvCell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) {
    return Quoted(*text);
  }
  return std::visit([](const auto& value) { return fmt::format("{}", value); }, cell);
}

}  // namespace

std::string CsvLine(const std::vector<CsvCell>& row) {
  std::string line;
  for (const CsvCell& cell : row) {
    if (&cell != &row.front()) {
      line += ',';
    }
    line += CellText(cell);
  }
  line += '\n';
  return line;
}

std::string CsvText(const std::vector<std::string>& header, const std::vector<std::vector<CsvCell>>& rows) {
  std::string text = CsvLine({header.begin(), header.end()});
  for (const std::vector<CsvCell>& row : rows) {
    FRESCO_CHECK(row.size() == header.size());
    text += CsvLine(row);
  }
  return text;
}

void WriteCsv(const std::filesystem::path& path, const std::vector<std::string>& header,
              const std::vector<std::vector<CsvCell>>& rows) {
  WriteFileAtomically(path, CsvText(header, rows));
}

}  // namespace fresco
