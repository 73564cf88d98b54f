// Writes an event log that LCM's own tools read, in one file or split by size. Never writes over a file.
// Belongs to one thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "bus/lcm_event.h"

namespace fresco {

class EventLogWriter {
 public:
  /// `split_bytes` 0: one file at `path`; otherwise PATH.00, PATH.01, .. as lcm-logger names them, each
  /// closed when it has reached that size. Throws UsageError where the file is there already or can't be
  /// made.
  explicit EventLogWriter(std::filesystem::path path, int64_t split_bytes = 0);
  ~EventLogWriter();
  EventLogWriter(const EventLogWriter&) = delete;
  EventLogWriter& operator=(const EventLogWriter&) = delete;

  /// Appends an event under the next number of its file. Throws Failure where the disk does not take it; what
  /// was written before stays.
  void Write(const LcmEvent& event);

  /// Hands everything written to the system. Throws Failure where the disk does not take it.
  void Flush();

  /// What an event takes in a log.
  static int64_t EventBytes(const LcmEvent& event);

  int64_t events() const { return events_; }
  int64_t bytes() const { return bytes_before_ + bytes_; }
  int files() const { return files_; }

 private:
  class File;

  void OpenNext();
  [[noreturn]] void ThrowDiskError() const;

  std::filesystem::path path_;
  int64_t split_bytes_;
  std::unique_ptr<File> file_;
  std::filesystem::path file_path_;
  int64_t events_ = 0;
  int64_t bytes_ = 0;         // of the file that is open
  int64_t bytes_before_ = 0;  // of those before
  int files_ = 0;
};

}  // namespace fresco
