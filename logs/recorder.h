// Records everything on a bus as LCM event logs. The thread that uses the object takes events off the bus
// into memory. A second thread, which the object starts, writes them, so a slow disk delays nothing. Memory
// is bounded: if it is full, events are dropped and counted. Only one thread may call its functions.
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
#include "logs/event_log_writer.h"
#include "logs/event_selection.h"

namespace fresco {

struct RecorderOptions {
  std::filesystem::path path = {};
  int64_t split_bytes = 0;  ///< as in EventLogWriter; 0: one file
  ChannelFilter channels = {};
  size_t memory_bytes = size_t{256} << 20;  ///< for events that wait for the disk
};

class Recorder {
 public:
  struct Totals {
    int64_t events = 0;          ///< events that were written or wait for the disk
    int64_t bytes = 0;           ///< their size in the log
    int64_t dropped_events = 0;  ///< events for which there was no memory
    int files = 0;               ///< number of files; set by Finish
  };

  /// Opens the log, then subscribes to all channels. `bus` must outlive the recorder. Throws UsageError if
  /// the log exists or can't be made, or if the bus can't be received.
  Recorder(Bus& bus, RecorderOptions options);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Adds events that have arrived to the batch to be written. If there are none, waits up to `timeout_us`
  /// for the first. Throws Failure if the log can't be written; the events written before can still be read.
  void Step(int64_t timeout_us);

  /// Adds the events that have arrived already, writes everything and closes the log. Throws as Step does.
  Totals Finish();

  const Totals& totals() const { return totals_; }

 private:
  struct Entry {
    int64_t utime;
    uint32_t channel_bytes;
    uint32_t message_bytes;
  };
  /// Events that wait for the disk. `bytes` holds channel and message of each, one after the other.
  struct Batch {
    std::vector<Entry> entries;
    std::vector<std::byte> bytes;
    size_t memory_bytes() const { return bytes.size() + entries.size() * sizeof(Entry); }
  };

  void Add(const LcmEvent& event);
  void WriteBatches();
  bool WaitForBatch();
  void WriteBatch();
  void EndThread();
  void ThrowProblem();

  Bus& bus_;
  RecorderOptions options_;
  Totals totals_;
  EventLogWriter writer_;  // used by the writing thread until that has ended
  Batch writing_;          // used by the writing thread only
  int64_t flush_at_us_ = 0;

  std::mutex mutex_;
  std::condition_variable changed_;
  Batch waiting_;
  bool ending_ = false;
  std::exception_ptr problem_;
  std::thread thread_;
};

}  // namespace fresco
