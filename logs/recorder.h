// Records everything on a bus as LCM event logs. The thread that owns it takes events off the bus into
// memory; a thread of the recorder's own writes them, so that a slow disk holds nothing up. Memory is
// bounded: what finds no room is dropped and counted. An object belongs to one thread.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <mutex>
#include <thread>
#include <vector>

#include "bus/bus.h"
#include "logs/channel_filter.h"
#include "logs/event_log_writer.h"

namespace fresco {

struct RecorderOptions {
  std::filesystem::path path = {};
  int64_t split_bytes = 0;  ///< as EventLogWriter has it
  ChannelFilter channels = {};
  size_t memory_bytes = size_t{256} << 20;  ///< for events that wait for the disk
};

class Recorder {
 public:
  struct Totals {
    int64_t events = 0;  ///< written, or waiting for the disk
    int64_t bytes = 0;   ///< of these in the log
    int64_t dropped_events = 0;
    int files = 0;  ///< known once it has finished
  };

  /// Opens the log, then subscribes: from here on nothing is missed. `bus` must outlive the recorder. Throws
  /// UsageError where the log is there already or can't be made, or the bus can't be heard.
  Recorder(Bus& bus, RecorderOptions options);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Takes what arrives, waiting for the first event up to `timeout_us`. Throws Failure where the disk does
  /// not take the log; what was written before can be read.
  void Step(int64_t timeout_us);

  /// Takes what has arrived already, writes everything and closes the log. Throws as Step does.
  Totals Finish();

  const Totals& totals() const { return totals_; }

 private:
  struct Entry {
    int64_t utime;
    uint32_t channel_bytes;
    uint32_t message_bytes;
  };
  /// Events that wait for the disk: channel and message of each, one behind the other.
  struct Batch {
    std::vector<Entry> entries;
    std::vector<std::byte> bytes;
    size_t memory_bytes() const { return bytes.size() + entries.size() * sizeof(Entry); }
  };

  void Take(const LcmEvent& event);
  void WriteBatches();
  bool TakeBatch();
  void WriteBatch();
  void EndThread();
  void ThrowProblem();

  Bus& bus_;
  RecorderOptions options_;
  Totals totals_;
  EventLogWriter writer_;  // of the thread, until it has ended
  Batch writing_;          // of the thread
  int64_t flush_at_us_ = 0;

  std::mutex mutex_;
  std::condition_variable changed_;
  Batch waiting_;
  bool ending_ = false;
  std::exception_ptr problem_;
  std::thread thread_;
};

}  // namespace fresco
