// A folder that one process at a time works in. The lock ends with the process, however it ends.
#pragma once

#include <cstdint>
#include <filesystem>

namespace fresco {

class FolderLock {
 public:
  /// Takes the lock, waiting up to `patience_us` for a process that is about to end. Throws UsageError
  /// where another process keeps it, naming the folder, and where the folder can't be opened. On a file
  /// system without locks it is never taken.
  explicit FolderLock(const std::filesystem::path& folder, int64_t patience_us = 0);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int fd_;
};

}  // namespace fresco
