// Where a training stands: what follows from the episodes committed so far, and nothing else. From it
// the trainer goes on bit for bit, and a checkpoint holds it. Plain values; networks are shared and
// never change.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "msgs/order.h"
#include "nn/adam.h"
#include "nn/mlp.h"
#include "worlds/uav/flight.h"

namespace fresco {

/// What one greedy flight showed of a version: its exact score, the environment being deterministic.
struct Evaluation {
  int64_t version = 0;
  int64_t updates = 0;
  int64_t episodes = 0;  ///< training episodes committed when the result was
  bool arrived = false;
  AoiFigures figures;
};

/// The best version so far: one that arrived with the smallest average AoI, the earliest of equals;
/// before any arrived, the last one.
struct BestNetwork {
  Evaluation evaluation;
  std::shared_ptr<const Vector> parameters;
};

struct TrainerProgress {
  int64_t committed_orders = 0;
  int64_t episodes = 0;
  int64_t transitions = 0;
  int64_t updates = 0;
  int64_t replay_size = 0;
  int32_t current_version = 0;
  int32_t target_version = 0;
  double epsilon = 0;            ///< of the newest training order
  double learning_rate = 0;      ///< of the newest update
  double loss = 0;               ///< exponential average over about 100 updates
  double staleness_updates = 0;  ///< from an order's writing to its commitment, exponential average
};

/// A version of one of the networks.
struct VersionState {
  NetworkKind kind = NetworkKind::kCurrent;
  int32_t version = 0;
  int64_t updates = 0;  ///< after which it was made
  std::shared_ptr<const Vector> parameters;
};

/// An order that is written and whose episode is not committed.
struct OrderInFlight {
  Order order;
  int64_t updates_at_writing = 0;
};

struct TrainingState {
  TrainerProgress progress;
  std::vector<OrderInFlight> orders;   ///< by index, from progress.committed_orders on without gap
  std::vector<VersionState> versions;  ///< those that these orders name, and the newest of each network
  Vector current;
  Vector target;
  Adam::State adam;
  /// The replay memory, as the actions of its episodes: the world being deterministic, everything else
  /// follows from them. Whole episodes, oldest first, from the one that the oldest transition in the
  /// replay memory belongs to.
  std::vector<int16_t> actions;
  std::optional<Evaluation> last_evaluation;
  std::optional<BestNetwork> best;
};

}  // namespace fresco
