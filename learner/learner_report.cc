#include "learner/learner_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>

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
  status.score_bound = kNan;
  status.optimum_proved = 0;
  status.gap_percent = status.gap_median_percent = status.gap_worst_percent = kNan;
  WriteOptimumTo(status);
}

void TrainingReport::WriteOptimumTo(learner_status_t& status) const {
  const size_t episodes = best ? best->evaluation.scores.size() : (optimum.size() == 1 ? 1 : 0);
  if (episodes == 0 || optimum.size() < episodes) {
    return;
  }
  const auto bounds = std::span(optimum).first(episodes);
  std::vector<double> least_scores;
  for (const OptimumBound& bound : bounds) {
    least_scores.push_back(bound.lower_bound_average_aoi);
  }
  if (*std::min_element(least_scores.begin(), least_scores.end()) <= 0) {
    return;
  }
  status.score_bound =
      std::accumulate(least_scores.begin(), least_scores.end(), 0.0) / static_cast<double>(episodes);
  status.optimum_proved =
      std::all_of(bounds.begin(), bounds.end(), [](const OptimumBound& bound) { return bound.proved; }) ? 1
                                                                                                        : 0;
  if (status.optimum_proved != 0 && best && best->evaluation.success == 1) {
    const Gaps gaps = GapsOf(best->evaluation.scores, least_scores);
    status.gap_percent = gaps.mean;
    status.gap_median_percent = gaps.median;
    status.gap_worst_percent = gaps.worst;
  }
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
