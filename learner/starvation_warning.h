// When a learner that waits for a result has to say so in its log: silence is never a hang. Says what to
// write; writing is the caller's. Used by one thread.
#pragma once

#include <optional>
#include <string>

namespace fresco {

class StarvationWarning {
 public:
  /// Told again and again how long the learner has waited and for what. Returns a line for the log: after
  /// five seconds, then every ten, and when it goes on.
  std::optional<std::string> Note(double starved_s, const std::string& waiting_for);

 private:
  double next_s_ = kFirstS;
  double last_s_ = 0;

  static constexpr double kFirstS = 5;
  static constexpr double kAgainS = 10;
};

}  // namespace fresco
