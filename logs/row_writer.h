// Writes a table row by row, as CSV or as JSON Lines. Only one thread may use an object.
#pragma once

#include <string>
#include <vector>

#include "logs/message_cells.h"
#include "logs/text_output.h"

namespace fresco {

class RowWriter {
 public:
  enum class Format { kCsv, kJsonLines };

  /// `output` must outlive the object.
  RowWriter(TextOutput& output, Format format) : output_(output), format_(format) {}

  /// Writes a row. JSON Lines: each row is one object, and NaN is null. CSV: the first row decides the
  /// header; throws Failure if a later row has other columns.
  void Write(const NamedRow& row);

  int64_t rows() const { return rows_; }

 private:
  void WriteCsvRow(const NamedRow& row);

  TextOutput& output_;
  Format format_;
  std::vector<std::string> header_;
  int64_t rows_ = 0;
};

}  // namespace fresco
