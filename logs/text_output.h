// Writes a subcommand's text to standard output or a file. Only one thread may use an object.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

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

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  [[noreturn]] void ThrowProblem() const;

  std::string path_;
  std::unique_ptr<std::FILE, Close> own_file_;
  std::FILE* file_;
};

}  // namespace fresco
