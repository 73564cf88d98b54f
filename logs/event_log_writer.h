// Writes an event log that LCM's own tools can read, as one file or split by size. Never overwrites a file.
// Only one thread at a time may use an object.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "bus/bus.h"

namespace fresco {

class EventLogWriter {
 public:
  /// If `split_bytes` is 0, writes one file at `path`. Otherwise writes PATH.00, PATH.01, .., as lcm-logger
  /// names them, and closes each when it has reached that size. Throws UsageError if the file exists or can't
  /// be made.
  explicit EventLogWriter(std::filesystem::path path, int64_t split_bytes = 0);
  ~EventLogWriter();
  EventLogWriter(const EventLogWriter&) = delete;
  EventLogWriter& operator=(const EventLogWriter&) = delete;

  /// Appends an event; its number is its position in its file. Throws Failure if it can't be written; the
  /// events before it can still be read.
  void Write(const LcmEvent& event);

  /// Passes all buffered events to the operating system. Throws Failure if they can't be written.
  void Flush();

  /// The number of bytes that an event takes in a log.
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
  int64_t bytes_ = 0;         // in the open file
  int64_t bytes_before_ = 0;  // in the files before it
  int files_ = 0;
};

}  // namespace fresco
