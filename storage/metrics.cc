#include "storage/metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>
#include <vector>

#include "core/bytes.h"
#include "core/error.h"
#include "msgs/proto/tensorboard.pb.h"

namespace fresco {
namespace {

std::vector<std::string> CellsOf(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) {
    cells.push_back(cell);
  }
  return cells;
}

template <class Number>
void AppendLittleEndian(Number number, std::string& bytes) {
  static_assert(std::endian::native == std::endian::little);
  char raw[sizeof(number)];
  std::memcpy(raw, &number, sizeof(number));
  bytes.append(raw, sizeof(number));
}

void AppendMaskedCrc(const std::string& bytes, std::string& record) {
  constexpr uint32_t kAdded = 0xa282ead8;
  constexpr int kRotation = 15;
  const uint32_t crc = Crc32c(std::as_bytes(std::span(bytes)));
  AppendLittleEndian(std::rotr(crc, kRotation) + kAdded, record);
}

void AppendRecord(const proto::TensorBoardEvent& event, std::string& records) {
  const std::string content = event.SerializeAsString();
  std::string length;
  AppendLittleEndian(uint64_t{content.size()}, length);
  records += length;
  AppendMaskedCrc(length, records);
  records += content;
  AppendMaskedCrc(content, records);
}

}  // namespace

size_t MetricsTable::ColumnOf(const std::string& name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw UsageError(
        fmt::format("metrics.csv: expected a column {}, found {}", name, fmt::join(names, ", ")));
  }
  return static_cast<size_t>(found - names.begin());
}

MetricsTable ParseMetrics(const std::string& metrics_csv) {
  MetricsTable table;
  std::istringstream stream(metrics_csv);
  std::string line;
  std::getline(stream, line);
  table.names = CellsOf(line);
  while (std::getline(stream, line)) {
    std::vector<double>& row = table.rows.emplace_back();
    for (const std::string& cell : CellsOf(line)) {
      char* end = nullptr;
      row.push_back(std::strtod(cell.c_str(), &end));
      if (end == cell.c_str() || *end != 0) {
        throw UsageError(fmt::format("metrics.csv: expected a number, found \"{}\"", cell));
      }
    }
    if (row.size() != table.names.size()) {
      throw UsageError(fmt::format("metrics.csv: expected {} numbers in a line, found {}", table.names.size(),
                                   row.size()));
    }
  }
  return table;
}

std::string MetricsJsonLines(const std::string& metrics_csv) {
  const MetricsTable table = ParseMetrics(metrics_csv);
  std::string lines;
  for (const std::vector<double>& row : table.rows) {
    nlohmann::ordered_json object;
    for (size_t column = 0; column < row.size(); ++column) {
      object[table.names[column]] = row[column];  // null if it is not finite
    }
    lines += object.dump() + "\n";
  }
  return lines;
}

std::string TensorBoardEvents(const std::string& metrics_csv, double begin_s) {
  const MetricsTable table = ParseMetrics(metrics_csv);
  const size_t wall_s = table.ColumnOf("wall_s");
  const size_t updates = table.ColumnOf("updates");
  std::string records;
  proto::TensorBoardEvent first;
  first.set_wall_time(begin_s);
  first.set_file_version("brain.Event:2");
  AppendRecord(first, records);
  for (const std::vector<double>& row : table.rows) {
    proto::TensorBoardEvent event;
    event.set_wall_time(begin_s + row[wall_s]);
    event.set_step(static_cast<int64_t>(row[updates]));
    for (size_t column = 0; column < row.size(); ++column) {
      if (column != wall_s && column != updates) {
        proto::TensorBoardValue& value = *event.mutable_summary()->add_value();
        value.set_tag((column < kTrainingColumns ? "training/" : "evaluation/") + table.names[column]);
        value.set_simple_value(static_cast<float>(row[column]));
      }
    }
    AppendRecord(event, records);
  }
  return records;
}

}  // namespace fresco
