// A folder for the files of a test.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>

namespace fresco {

/// A new folder of this process: empty at first, removed with everything in it at the end.
class TemporaryFolder {
 public:
  TemporaryFolder()
      : path_(std::filesystem::temp_directory_path() /
              ("fresco-test-" + std::to_string(getpid()) + "-" + std::to_string(next_number_++))) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  static inline int next_number_ = 0;
  std::filesystem::path path_;
};

}  // namespace fresco
