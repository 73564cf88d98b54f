// Reads one of LCM's event logs (the files of lcm-logger), event by event and in blocks: the memory does
// not depend on the log's size. A log that was cut short is read to the cut; bytes in its midst that are no
// event are skipped; both are counted. Belongs to one thread.
//
// An event is, big-endian: the sync word 0xEDA1DA01, int64 number, int64 microseconds since the epoch,
// int32 length of the channel's name, int32 length of the message, the name, the message.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "bus/lcm_event.h"

namespace fresco {

class EventLogReader {
 public:
  /// Throws UsageError where the file can't be read, or where it does not begin as an event log does. A file
  /// that is empty, or too short to tell, is a log without a whole event.
  explicit EventLogReader(std::filesystem::path path);
  ~EventLogReader();
  EventLogReader(const EventLogReader&) = delete;
  EventLogReader& operator=(const EventLogReader&) = delete;

  /// The next whole event, valid until the next call; nullopt at the end, where a log that has grown goes on
  /// with the call after. Throws Failure where the disk can't be read.
  std::optional<LcmEvent> Next();

  const std::filesystem::path& path() const { return path_; }
  /// Bytes from the file's beginning to the end of what Next has handed out or skipped.
  int64_t position() const { return position_; }
  /// Bytes skipped so far that are no event.
  int64_t damaged_bytes() const { return damaged_bytes_; }
  /// Bytes of an event that ends beyond the file's end; known when Next has returned nullopt.
  int64_t torn_bytes() const { return torn_bytes_; }

 private:
  LcmEvent Take(size_t event_bytes, size_t channel_bytes);
  bool SwallowsAnother(size_t event_bytes);
  bool HasWholeEvent(int64_t end);
  bool WholeEventBeginsAt(int64_t offset) const;
  void SkipDamage();
  std::span<const std::byte> buffered() const;
  bool Buffer(size_t bytes);
  size_t ReadAt(int64_t offset, std::span<std::byte> bytes) const;
  int64_t FileBytes() const;

  std::filesystem::path path_;
  int descriptor_ = -1;
  std::vector<std::byte> block_;
  size_t begin_ = 0;  // of what is buffered, in the block
  size_t end_ = 0;
  int64_t position_ = 0;
  int64_t damaged_bytes_ = 0;
  int64_t torn_bytes_ = 0;
  int64_t whole_event_ = -1;  // where HasWholeEvent has found one: it looks at no byte of damage twice
};

}  // namespace fresco
