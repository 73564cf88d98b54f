// Writes what a subcommand puts out, to standard output or a file: texts, and tables row by row. Only one
// thread may use an object.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "logs/exported_messages.h"

namespace fresco {

class TextOutput {
 public:
  /// Opens the file `path`, which it overwrites, or uses standard output if `path` is empty. Throws
  /// UsageError if the file can't be opened.
  explicit TextOutput(std::string path = {});

  /// Writes the text. Throws Failure if it can't.
  void Write(std::string_view text);
  /// Passes all buffered text to the operating system. Throws as Write does.
  void Flush();

  /// The path, or "standard output".
  std::string name() const { return path_.empty() ? "standard output" : path_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const {
      if (file != stdout) {
        std::fclose(file);
      }
    }
  };

  [[noreturn]] void ThrowProblem() const;

  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
};

/// Writes a table as CSV or as JSON Lines.
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
