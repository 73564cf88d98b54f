// Records a run's traffic during the run. It starts `fresco log record` as a separate process, so the
// recording shares only the bus with learner and actors. TrainingRun owns it and uses it on its thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "core/child_process.h"

namespace fresco {

class RunRecorder {
 public:
  /// Records the traffic of `lcm_url` to traffic.lcm in the run's folder. If the run was recorded before and
  /// is resumed, the file is traffic-2.lcm and so on. Splits it into files of `split_mb` megabytes unless
  /// that is 0. Returns when the recorder is ready. Throws with the recorder's own words if it can't start.
  RunRecorder(const std::filesystem::path& folder, const std::string& lcm_url, double split_mb);
  /// Ends the recording properly.
  ~RunRecorder();
  RunRecorder(const RunRecorder&) = delete;
  RunRecorder& operator=(const RunRecorder&) = delete;

  /// Logs an error, once, if the recorder has ended by itself.
  void Step();

  /// Lets the recorder write what has arrived, and ends it. Call it after learner and actors have ended.
  void End();

  /// Returns one line: what was recorded and what can be done with it, or that the recording is incomplete.
  /// Call it after End.
  std::string Report() const;

 private:
  void WaitUntilItRecords(uintmax_t log_bytes_before);

  std::filesystem::path folder_;
  std::filesystem::path log_;
  std::unique_ptr<ChildProcess> process_;
  bool has_failed_ = false;
};

}  // namespace fresco
