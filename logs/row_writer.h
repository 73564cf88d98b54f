// A table written row by row, as CSV or as JSON Lines. Belongs to one thread.
#pragma once

#include <string>
#include <vector>

#include "logs/message_cells.h"
#include "logs/text_output.h"

namespace fresco {

class RowWriter {
 public:
  enum class Format { kCsv, kJsonLines };

  RowWriter(TextOutput& output, Format format) : output_(output), format_(format) {}

  /// JSON Lines: an object a row; what is no number is null. CSV: the first row gives the header; throws
  /// Failure where another has other columns.
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
