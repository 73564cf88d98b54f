// The deterministic heart of the learner: takes episodes in the order of their indices, and from
// them alone follow every update, every version, every further order and the final weights. Knows
// no bus, no clock and no actor. Not thread-safe.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "learner/dqn.h"
#include "learner/replay_memory.h"
#include "msgs/episode.h"
#include "msgs/experiment.h"
#include "msgs/order.h"
#include "uav/flight.h"
#include "uav/network_input.h"

namespace fresco {

/// What one greedy flight showed of a version: its exact score, the environment being deterministic.
struct Evaluation {
  int64_t version = 0;
  int64_t updates = 0;
  int64_t episodes = 0;  ///< training episodes committed when the result was
  bool arrived = false;
  AoiFigures figures;
};

/// Where the trainer hands out what follows from the episodes. All are called from within Begin and
/// Commit.
struct TrainerOutput {
  std::function<void(const Order&)> order;
  std::function<void(NetworkKind, int32_t version, std::shared_ptr<const Vector>)> version;
  std::function<void(const Evaluation&)> evaluation;
  /// Called after every update, for progress and interruption; may be empty.
  std::function<void()> updated;
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

/// The best version so far: one that arrived with the smallest average AoI, the earliest of equals;
/// before any arrived, the last one.
struct BestNetwork {
  Evaluation evaluation;
  std::shared_ptr<const Vector> parameters;
};

class Trainer {
 public:
  /// `world` must outlive the trainer.
  Trainer(const Experiment& experiment, const World& world, TrainerOutput output);

  /// Hands out version 0 of both networks and the first orders. Called once.
  void Begin();

  /// Takes the episode of the order with the lowest index that has not been committed. CHECKs the
  /// index; the episode is whole and was checked.
  void Commit(const Order& order, const Episode& episode);

  /// Every training episode is committed and the final version is evaluated.
  bool finished() const { return finished_; }

  const TrainerProgress& progress() const { return progress_; }
  const Vector& current() const { return dqn_.current(); }
  const std::optional<BestNetwork>& best() const { return best_; }
  const std::optional<Evaluation>& last_evaluation() const { return last_evaluation_; }

 private:
  /// A version of the current network and after how many updates it was made.
  struct Version {
    std::shared_ptr<const Vector> parameters;
    int64_t updates = 0;
  };

  void CommitTraining(const Episode& episode);
  void CommitEvaluation(const Order& order, const Episode& episode);
  void TakeLeastValues(const Episode& episode);
  void Insert(const Episode& episode, int transition);
  void UpdateOnce();
  void CopyToTarget();
  void MakeVersion();
  void WriteNextOrder();
  void WriteOrder(OrderKind kind);
  void FinishTraining();

  Experiment experiment_;
  const World* world_;
  TrainerOutput output_;
  int64_t expected_updates_;
  NetworkInput network_input_;
  ReplayMemory replay_;
  MiniBatch batch_;
  Dqn dqn_;
  std::vector<float> observation_;
  std::vector<float> next_observation_;
  std::vector<float> least_values_;  // of the episode's transitions
  TrainerProgress progress_;
  int64_t next_index_ = 0;       // of the next order to write
  int64_t training_orders_ = 0;  // written
  bool evaluation_due_ = false;
  Version newest_;
  std::map<int64_t, Version> evaluating_;          // by index of the evaluation order
  std::map<int64_t, int64_t> updates_at_writing_;  // by index of the order
  bool final_evaluation_written_ = false;
  bool finished_ = false;
  std::optional<Evaluation> last_evaluation_;
  std::optional<BestNetwork> best_;
};

}  // namespace fresco
