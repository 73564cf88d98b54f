// Decides when the learner announces its run, makes the messages, and notices other runs on the same
// channels. LearnerNode owns it. Not thread-safe.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "msgs/experiment.h"
#include "msgs/wire.h"
#include "training/training_state.h"

namespace fresco {

class RunAnnouncer {
 public:
  RunAnnouncer(const Experiment& experiment, int64_t run_id);

  /// An actor asks which run there is, so the next announcement is due sooner.
  void Ask() { was_asked_ = true; }
  /// Whether to announce the run now. If so, the next announcement is due a period later.
  bool IsDue(int64_t now_us);
  /// The messages of one announcement: each has a part of the configuration. The caller stamps and sends
  /// them.
  std::vector<run_t> Messages(const TrainerProgress& progress, bool finished);

  /// Judges an announcement that arrived on `channel` at `now_utime`, microseconds since the epoch. Returns
  /// false if it is this run's own. Logs the first one of another run, and the first one of a recorded run.
  bool IsForeign(const run_t& message, const std::string& channel, int64_t now_utime);
  /// The run of the last foreign announcement that is current; 0: there was none.
  int64_t foreign_run() const { return foreign_run_; }

 private:
  int64_t run_id_;
  run_t announcement_{};
  std::string config_text_;
  int64_t next_us_ = 0;
  bool was_asked_ = false;
  bool announced_ = false;
  int64_t foreign_run_ = 0;
  bool warned_of_foreign_run_ = false;
  bool warned_of_recorded_run_ = false;
};

}  // namespace fresco
