// What a person sees of a run: one live line on a terminal, plain lines elsewhere, a table at the end.
#pragma once

#include <cstdint>
#include <string>

#include "msgs/wire.h"

namespace fresco {

/// One line: episodes, updates, epsilon, greedy average AoI, rates, who waits for whom.
std::string ProgressLine(const learner_status_t& status);

/// Shows statuses on standard error: in place on a terminal, otherwise a line every few seconds.
class ProgressDisplay {
 public:
  explicit ProgressDisplay(bool enabled);
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  void Show(const learner_status_t& status, int64_t now_us);
  /// Ends the live line, so that other output begins on a line of its own.
  void Finish();

 private:
  bool enabled_;
  bool terminal_;
  bool line_open_ = false;
  int64_t next_us_ = 0;
};

/// The final table: this run and the baselines, from a summary's JSON.
std::string ResultTable(const std::string& summary_json);

}  // namespace fresco
