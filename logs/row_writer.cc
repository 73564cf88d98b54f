#include "logs/row_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "core/error.h"

namespace fresco {

TextOutput::TextOutput(std::string path)
    : path_(std::move(path)), file_(path_.empty() ? stdout : std::fopen(path_.c_str(), "we")) {
  if (file_ == nullptr) {
    throw UsageError(fmt::format("--out: can't write {}: {}", path_, std::strerror(errno)));
  }
}

void TextOutput::Write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size()) {
    ThrowProblem();
  }
}

void TextOutput::Flush() {
  if (std::fflush(file_.get()) != 0) {
    ThrowProblem();
  }
}

void TextOutput::ThrowProblem() const {
  throw Failure(fmt::format("can't write {}: {}", name(), std::strerror(errno)));
}

void RowWriter::Write(const NamedRow& row) {
  if (format_ == Format::kCsv) {
    WriteCsvRow(row);
  } else {
    output_.Write(RowJson(row) + "\n");
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
    throw Failure(fmt::format(
        "{}: row {} has other columns than those before: the logs contain runs of different worlds, or "
        "states that are too long for one message; export one of the runs (--run ID, see fresco "
        "log info) or use --format jsonl",
        output_.name(), rows_ + 1));
  }
  std::vector<CsvCell> cells;
  for (const auto& [name, cell] : row) {
    cells.push_back(cell);
  }
  output_.Write(CsvLine(cells));
}

}  // namespace fresco
