// Decides when a learner that waits for a result writes a line to its log, so that a silent log never means a
// hang. Returns the line; the caller writes it. LearnerNode owns it and uses it on its network thread only.
#pragma once

#include <optional>
#include <string>

namespace fresco {

class StarvationWarning {
 public:
  /// Call this often, with how long the learner has waited (0 if it does not wait) and for what. Returns a
  /// line for the log after five seconds of waiting, then every ten seconds, and when a result has arrived
  /// after that.
  std::optional<std::string> Note(double starved_s, const std::string& waiting_for);

 private:
  double next_s_ = kFirstS;
  double last_s_ = 0;

  static constexpr double kFirstS = 5;
  static constexpr double kAgainS = 10;
};

}  // namespace fresco
