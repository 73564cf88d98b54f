// Reads an event log of LCM (a file of lcm-logger) event by event. It reads in blocks, so the memory does not
// depend on the log's size. If the log was cut short, it reads all events before the cut. It skips damaged
// bytes between events. It counts both. Only one thread may use an object.
//
// The format of an event, big-endian: the sync word 0xEDA1DA01, int64 number, int64 microseconds since the
// epoch, int32 length of the channel's name, int32 length of the message, the name, the message.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "bus/bus.h"

namespace fresco {

/// The bytes before the channel of each event in an event log: sync word, number, time and two lengths,
/// big-endian.
inline constexpr size_t kEventHeaderBytes = 28;

class EventLogReader {
 public:
  enum class Beginning {
    kSound,         ///< a file that does not begin with a sync word is refused: it is probably no log
    kMaybeDamaged,  ///< bytes before the first event are skipped as damage
  };

  /// Opens the file. Throws UsageError if it can't be read or does not begin like an event log. A file that
  /// is empty or shorter than a sync word counts as a log without events.
  explicit EventLogReader(std::filesystem::path path, Beginning beginning = Beginning::kSound);
  ~EventLogReader();
  EventLogReader(const EventLogReader&) = delete;
  EventLogReader& operator=(const EventLogReader&) = delete;

  /// Returns the next complete event, valid until the next call; nullopt at the end. If the log has grown
  /// since, the next call returns the next event. Throws Failure if the file can't be read.
  std::optional<LcmEvent> Next();

  const std::filesystem::path& path() const { return path_; }
  /// The position in the file, bytes: behind the last event that Next returned, or behind damage that it
  /// skipped.
  int64_t position() const { return position_; }
  /// The number of bytes skipped so far because they are damaged.
  int64_t damaged_bytes() const { return damaged_bytes_; }
  /// The number of bytes of an incomplete last event. Known after Next has returned nullopt.
  int64_t torn_bytes() const { return torn_bytes_; }

 private:
  LcmEvent Consume(size_t event_bytes, size_t channel_bytes);
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
  size_t begin_ = 0;  // block_[begin_ .. end_ - 1] is buffered and not handed out yet
  size_t end_ = 0;
  int64_t position_ = 0;
  int64_t damaged_bytes_ = 0;
  int64_t torn_bytes_ = 0;
  int64_t whole_event_ = -1;  // where HasWholeEvent found an event, so that it examines no damaged byte twice
};

}  // namespace fresco
