#include "learner/learner_report.h"

#include <fmt/format.h>

#include <limits>

namespace fresco {

void TrainingReport::WriteTo(learner_status_t& status) const {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  status.committed_orders = progress.committed_orders;
  status.episodes = progress.episodes;
  status.transitions = progress.transitions;
  status.updates = progress.updates;
  status.replay_size = progress.replay_size;
  status.current_version = progress.current_version;
  status.target_version = progress.target_version;
  status.epsilon = progress.epsilon;
  status.learning_rate = progress.learning_rate;
  status.loss = progress.loss;
  status.staleness_updates = progress.staleness_updates;
  status.score = last_evaluation ? last_evaluation->score() : kNan;
  status.success = last_evaluation ? last_evaluation->success : 0;
  status.best_score = best && best->evaluation.success > 0 ? best->evaluation.score() : kNan;
  status.score_bound = optimum ? optimum->lower_bound_average_aoi : kNan;
  status.optimum_proved = optimum && optimum->proved ? 1 : 0;
  status.gap_percent =
      status.optimum_proved != 0 ? GapPercent(status.best_score, optimum->lower_bound_average_aoi) : kNan;
}

std::optional<std::string> StarvationWarning::Note(double starved_s, const std::string& waiting_for) {
  std::optional<std::string> line;
  if (starved_s < last_s_) {
    if (next_s_ > kFirstS) {
      line = fmt::format("a result arrived after {:.0f} s; the run continues", last_s_);
    }
    next_s_ = kFirstS;
  } else if (starved_s > next_s_) {
    line = fmt::format("no result for {:.0f} s: waiting for {}", starved_s, waiting_for);
    next_s_ = starved_s + kAgainS;
  }
  last_s_ = starved_s;
  return line;
}

}  // namespace fresco
