#include "logs/text_output.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "core/error.h"

namespace fresco {

TextOutput::TextOutput(std::string path) : path_(std::move(path)), file_(stdout) {
  if (!path_.empty()) {
    own_file_.reset(std::fopen(path_.c_str(), "we"));
    file_ = own_file_.get();
    if (file_ == nullptr) {
      throw UsageError(fmt::format("--out: can't write {}: {}", path_, std::strerror(errno)));
    }
  }
}

void TextOutput::Write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) {
    ThrowProblem();
  }
}

void TextOutput::Flush() {
  if (std::fflush(file_) != 0) {
    ThrowProblem();
  }
}

void TextOutput::ThrowProblem() const {
  throw Failure(
      fmt::format("can't write {}: {}", path_.empty() ? "standard output" : path_, std::strerror(errno)));
}

}  // namespace fresco
