// What the tests of figures share: a folder of their own, and a look at the files in it.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace fresco {

/// Empty at first; gone in the end.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(const std::string& name);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  int files() const;

 private:
  std::filesystem::path path_;
};

/// Whether a strict parser of another project (expat, in Python) accepts the file.
bool ParsesAsXml(const std::filesystem::path& path);

/// Width and height in the header of a PNG with its signature and its last chunk; zeros where it is none.
std::pair<unsigned, unsigned> PngSize(const std::string& content);

int Count(const std::string& text, const std::string& part);

/// The numbers of the datablock `$name` of a gnuplot script, line by line; an empty line is an empty row.
std::vector<std::vector<double>> DataBlock(const std::string& script, const std::string& name);

}  // namespace fresco
