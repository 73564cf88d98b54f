// Text that a subcommand writes line by line, to standard output or a file. Belongs to one thread.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

namespace fresco {

class TextOutput {
 public:
  /// To the file, which is written over; to standard output where `path` is empty. Throws UsageError where it
  /// can't be opened.
  explicit TextOutput(std::string path = {});

  /// Throws Failure where the text can't be written.
  void Write(std::string_view text);
  /// Hands everything to the system; throws as Write does.
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
