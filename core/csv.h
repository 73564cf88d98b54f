// Tables as comma-separated values, for figures and whoever wants to draw them anew. Any thread may call
// these functions.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace fresco {

using CsvCell = std::variant<std::string, int64_t, double>;

/// One row, ending in a line feed, quoted and rounded as CsvText says.
std::string CsvLine(const std::vector<CsvCell>& row);

/// One line a row, ending in a line feed; the header first. Text is quoted as RFC 4180 says if it has to
/// be; a double has the fewest digits that read back as the same double. Every row has as many cells
/// as the header.
std::string CsvText(const std::vector<std::string>& header, const std::vector<std::vector<CsvCell>>& rows);

/// Writes the table completely or not at all. Throws Failure naming the path and the cause.
void WriteCsv(const std::filesystem::path& path, const std::vector<std::string>& header,
              const std::vector<std::vector<CsvCell>>& rows);

}  // namespace fresco
