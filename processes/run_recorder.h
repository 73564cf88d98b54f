// Records a run's traffic beside it: `fresco log record` as a process of its own, so that the recording
// shares nothing with learner and actors but the bus. Owned by TrainingRun and used by its thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/child_process.h"

namespace fresco {

class RunRecorder {
 public:
  /// Records what is on `lcm_url` to traffic.lcm in the run's folder, or to traffic-2.lcm and so on where a
  /// run that is resumed was recorded before; in files of `split_mb` megabytes, unless that is 0. Returns
  /// once everything that is sent is recorded. Throws with the recorder's own words where it can't start.
  RunRecorder(const std::filesystem::path& folder, const std::string& lcm_url, double split_mb);
  /// Ends the recording in order.
  ~RunRecorder();
  RunRecorder(const RunRecorder&) = delete;
  RunRecorder& operator=(const RunRecorder&) = delete;

  /// Says on standard error, once, where the recording has ended by itself.
  void Step();

  /// Lets the recorder write what has arrived, and ends it. To be called when all others have ended.
  void End();

  /// What was recorded and what can be done with it, or that the recording is incomplete; one line. Known
  /// once the recording has ended.
  std::string Report() const;

 private:
  void WaitUntilItRecords(uintmax_t log_bytes_before);

  std::filesystem::path folder_;
  std::filesystem::path log_;
  std::unique_ptr<ChildProcess> process_;
  bool has_failed_ = false;
};

/// The event logs of the run in this folder, in the order in which they were recorded.
std::vector<std::filesystem::path> RecordedLogs(const std::filesystem::path& folder);

}  // namespace fresco
