// Files that are written completely or not at all, and the folders that they are written to. Any thread may
// call these functions.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace fresco {

/// Writes `content` to a temporary file beside `path`, syncs it, renames it over `path` and syncs the folder.
/// Throws Failure naming the path and the cause (a full disk, say); `path` is then unchanged.
void WriteFileAtomically(const std::filesystem::path& path, std::string_view content);

/// Whether this is the temporary file of WriteFileAtomically, left by a process that was killed.
bool IsTemporaryOfAtomicFile(const std::filesystem::path& path);

/// The content of a file. Throws UsageError naming the path if it can't be read.
std::string ReadFile(const std::filesystem::path& path);

/// Throws UsageError, naming `option` and the cause, unless `folder` is a folder that this process may write
/// to, or can be made. Makes nothing.
void CheckOutputFolder(const std::filesystem::path& folder, const std::string& option = "--out");

/// Reserves a folder for one process at a time. The lock ends with the process, however it ends.
class FolderLock {
 public:
  /// Locks the folder, waiting up to `patience_us` for a process that is about to end. Throws UsageError,
  /// naming the folder, if another process keeps it or the folder can't be opened. On a file
  /// system without locks, nothing is locked and nothing thrown.
  explicit FolderLock(const std::filesystem::path& folder, int64_t patience_us = 0);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int fd_;
};

}  // namespace fresco
