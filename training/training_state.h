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
#include "nn/mlp.h"
#include "worlds/uav/aoi_figures.h"

namespace fresco {

/// The result of one greedy flight with a version of the current network. It is the version's exact score,
/// since the environment is deterministic.
struct Evaluation {
  int64_t version = 0;
  int64_t updates = 0;   ///< updates made when the version was made
  int64_t episodes = 0;  ///< training episodes committed when the result was committed
  bool arrived = false;  ///< whether the flight reached the stop within time and energy
  AoiFigures figures;
};

/// The best version so far: among the versions that arrived, the one with the smallest average AoI (the
/// earliest, if several have it). As long as none has arrived, it is the version evaluated last.
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
  /// The actions of the episodes whose transitions are in the replay memory, oldest first. The episodes are
  /// complete, so the first one may begin before the oldest transition in the memory. The world is
  /// deterministic, so the transitions follow from the actions.
  std::vector<int16_t> actions;
  std::optional<Evaluation> last_evaluation;
  std::optional<BestNetwork> best;
};

}  // namespace fresco
