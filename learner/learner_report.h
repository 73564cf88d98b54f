// What the learner tells people: the figures in its status, and when it logs that it starves. LearnerNode
// owns one of each. Not thread-safe.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "msgs/wire.h"
#include "storage/optimum_search.h"
#include "training/training_state.h"

namespace fresco {

/// What the training thread reports of itself. A plain value.
struct TrainingReport {
  TrainerProgress progress = {};
  std::optional<Evaluation> last_evaluation = {};
  std::optional<BestNetwork> best = {};
  std::vector<OptimumBound> optimum = {};  ///< by episode of an evaluation; further ones are ignored
  /// What the learner itself is busy with before it ends, in place of an actor; empty: nothing.
  std::string finishing = {};
  /// What somebody has to see to ("the last checkpoint could not be written: ..."); empty: nothing.
  std::string warning = {};

  /// Fills in the fields about progress, evaluations and the optimum.
  void WriteTo(learner_status_t& status) const;

 private:
  void WriteOptimumTo(learner_status_t& status) const;
};

/// Decides when a learner that waits for a result writes a line to its log, so that a silent log never means
/// a hang. Not thread-safe.
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
