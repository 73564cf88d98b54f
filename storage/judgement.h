// The judgement of a policy by some episodes: its figures beside those of the world's reference policies and
// of the exact optimum in the same episodes. summary.json and `evaluate` have it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "planner/planner.h"
#include "training/training_state.h"

namespace fresco {

/// The figures of some episodes of one policy.
class PolicyFigures {
 public:
  /// Adds an episode that has ended.
  void Add(const World& world, const Episode& episode);

  const std::vector<double>& scores() const { return scores_; }                 ///< by episode
  const std::vector<std::vector<double>>& figures() const { return figures_; }  ///< by episode
  const std::vector<bool>& succeeded() const { return succeeded_; }             ///< by episode
  std::vector<double> Means() const;                                            ///< by figure
  double success() const;  ///< share of the episodes, 0 to 1

 private:
  std::vector<double> scores_;
  std::vector<std::vector<double>> figures_;
  std::vector<bool> succeeded_;
};

/// What is judged, and by what.
struct JudgementInputs {
  const World& world;
  std::span<const uint64_t> seeds;  ///< of the episodes
  /// Means of the policy's figures, and its score by episode; null: nothing is known of it.
  const Evaluation* policy;
  /// By episode, null where there is none; empty: there was no search.
  std::span<const std::shared_ptr<const Plan>> plans;
};

/// Returns a JSON object.
///  - `world` has the kind of world, the name of an episode's success, and its figures with their units; the
///  first
///    one is the score.
///  - `score`, `success` and every figure by its name are those of the policy; the success by its name says
///    whether all episodes succeeded. All of them are null if nothing is known of it.
///  - `baselines` has the same of each reference policy of the world; it is missing if the world has none.
/// Only worlds with a search for the optimum have the following. All of them are means over the episodes:
///  - `optimal_...` are the figures of the exact optimum; null if it is not proved for every episode.
///  - `gap_percent` says how far the score is above the optimum; null if that is not proved, or if not every
///    episode of the policy succeeded. Each baseline has it, too.
///  - `best_found_...` are the figures of the best episodes that the search found, which may be the optimum.
///  No
///    policy has a score below `lower_bound_...`. Both are null if the search has no result for some episode.
/// With several episodes that have a plan, there are also:
///  - `gap_median_percent` and `gap_worst_percent`.
///  - `judged_episodes`, for each episode its seed, its group (World::GroupOf), the score and the optimal
///  one, the
///    gap (null if it is not proved) and in `baselines` their scores.
std::string JudgementJson(const JudgementInputs& inputs);

}  // namespace fresco
