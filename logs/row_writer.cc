#include "logs/row_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/error.h"

namespace fresco {
namespace {

using OrderedJson = nlohmann::ordered_json;

std::string JsonLine(const NamedRow& row) {
  OrderedJson json = OrderedJson::object();
  for (const auto& [name, cell] : row) {
    json[name] = std::visit([](const auto& value) { return OrderedJson(value); }, cell);
  }
  return json.dump(-1, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

}  // namespace

void RowWriter::Write(const NamedRow& row) {
  if (format_ == Format::kCsv) {
    WriteCsvRow(row);
  } else {
    output_.Write(JsonLine(row));
  }
  ++rows_;
}

void RowWriter::WriteCsvRow(const NamedRow& row) {
  if (rows_ == 0) {
    std::vector<CsvCell> names;
    for (const auto& [name, cell] : row) {
      header_.push_back(name);
      names.emplace_back(name);
    }
    output_.Write(CsvLine(names));
  }
  const bool fits =
      std::equal(row.begin(), row.end(), header_.begin(), header_.end(),
                 [](const auto& named, const std::string& name) { return named.first == name; });
  if (!fits) {
    throw Failure(
        fmt::format("row {} has {} columns, but the table has {}: the logs contain runs of different "
                    "scenarios; export one of them (--run ID, see fresco log info) or use --format jsonl",
                    rows_ + 1, row.size(), header_.size()));
  }
  std::vector<CsvCell> cells;
  for (const auto& [name, cell] : row) {
    cells.push_back(cell);
  }
  output_.Write(CsvLine(cells));
}

}  // namespace fresco
