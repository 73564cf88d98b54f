// The state of a training between two commits. The trainer can continue from it with the same bits, and a
// checkpoint stores it. Plain values; networks are shared and never change, so threads may copy a state
// freely.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "msgs/weights_codec.h"
#include "nn/adam.h"
#include "nn/network.h"
#include "worlds/episode.h"

namespace fresco {

/// The result of greedy episodes with a version of the current network (schedule.evaluation_episodes).
struct Evaluation {
  int64_t version = 0;
  int64_t updates = 0;          ///< updates made when the version was made
  int64_t episodes = 0;         ///< training episodes committed when the result was committed
  double success = 0;           ///< share of its episodes that succeeded, 0 to 1
  std::vector<double> figures;  ///< means over its episodes, in the order of WorldDescription::figures
  std::vector<double> scores;   ///< by episode: the first figure

  double score() const { return figures.front(); }
};

/// The best version so far: the one with the largest success, and among these the best score (the earliest,
/// if several have it). As long as none has succeeded at all, it is the version evaluated last.
struct BestNetwork {
  Evaluation evaluation;
  std::shared_ptr<const Vector> parameters;
};

struct TrainerProgress {
  int64_t committed_orders = 0;  ///< orders committed so far, evaluations included
  int64_t episodes = 0;          ///< training episodes committed so far
  int64_t transitions = 0;       ///< transitions inserted into the replay memory so far
  int64_t updates = 0;           ///< updates of the current network so far
  int64_t replay_size = 0;       ///< transitions in the replay memory now
  int32_t current_version = 0;   ///< newest version of the current network
  int32_t target_version = 0;    ///< newest version of the target network
  double epsilon = 0;            ///< of the newest training order
  double learning_rate = 0;      ///< of the newest update
  double loss = 0;               ///< exponential average over about 100 updates
  double staleness_updates = 0;  ///< updates between an order's writing and its commitment, exponential
                                 ///< average
  /// Whether the training is over and the best version, as the newest version, is judged by fresh episodes.
  bool delivering = false;
};

/// What is known of the evaluation whose episodes are being committed.
struct PartialEvaluation {
  int episodes = 0;             ///< committed so far
  int successes = 0;            ///< how many of them succeeded
  std::vector<double> figures;  ///< sums over them
  std::vector<double> scores;   ///< by episode: the first figure
};

/// The parameters of a network version.
struct VersionState {
  NetworkVersion version;
  int64_t updates = 0;  ///< updates made when the version was made
  std::shared_ptr<const Vector> parameters;
};

/// An order that was written and whose episode is not committed yet.
struct OrderInFlight {
  Order order;
  int64_t updates_at_writing = 0;  ///< updates made when the order was written; measures staleness
};

struct TrainingState {
  TrainerProgress progress;
  std::vector<OrderInFlight> orders;   ///< sorted by index, from progress.committed_orders on, without gaps
  std::vector<VersionState> versions;  ///< those that these orders name, and the newest of each network
  Vector current;
  Vector target;
  Adam::State adam;
  /// The episodes whose transitions are in the replay memory, oldest first. They are complete, so the first
  /// one may begin before the oldest transition in the memory.
  std::vector<std::shared_ptr<const Episode>> replay;
  PartialEvaluation partial_evaluation;
  std::optional<Evaluation> last_evaluation;
  std::optional<BestNetwork> best;
  std::optional<Evaluation> delivered;  ///< of the best version, by fresh episodes
};

}  // namespace fresco
