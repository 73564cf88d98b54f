// The deterministic heart of the learner: takes episodes in the order of their indices, and from
// them alone follow every update, every version, every further order and the final weights. Knows
// no bus, no clock and no actor. Not thread-safe.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "msgs/episode.h"
#include "msgs/experiment.h"
#include "training/action_history.h"
#include "training/dqn.h"
#include "training/replay_memory.h"
#include "training/training_state.h"
#include "worlds/uav/network_input.h"

namespace fresco {

/// Where the trainer hands out what follows from the episodes. All are called from within Begin, Resume
/// and Commit.
struct TrainerOutput {
  std::function<void(const Order&)> order;
  std::function<void(NetworkKind, int32_t version, std::shared_ptr<const Vector>)> version;
  std::function<void(const Evaluation&)> evaluation;
  /// Called after every update, for progress; may be empty.
  std::function<void()> updated;
};

class Trainer {
 public:
  /// `world` must outlive the trainer.
  Trainer(const Experiment& experiment, const World& world, TrainerOutput output);

  /// Hands out version 0 of both networks and the first orders. Either Begin or Resume is called, once.
  void Begin();

  /// Goes on from `state`: hands out its versions and, once more, its orders. Throws Failure where the
  /// state contradicts the experiment; the trainer is then of no use.
  void Resume(const TrainingState& state);

  /// Where the training stands, for Resume. Copies four parameter vectors and the actions.
  TrainingState Save() const;

  /// Takes the episode of the order with the lowest index that has not been committed. CHECKs the
  /// index; the episode is whole and was checked.
  void Commit(const Order& order, const Episode& episode);

  /// Every training episode is committed and the final version is evaluated.
  bool finished() const { return AllEpisodesCommitted() && orders_.empty(); }

  const TrainerProgress& progress() const { return progress_; }
  const Vector& current() const { return dqn_.current(); }
  const std::optional<BestNetwork>& best() const { return best_; }
  const std::optional<Evaluation>& last_evaluation() const { return last_evaluation_; }

 private:
  using VersionKey = std::pair<NetworkKind, int32_t>;

  void CommitTraining(const Episode& episode);
  void CommitEvaluation(const Order& order, const Episode& episode);
  void TakeLeastValues(const Episode& episode);
  void Insert(const Episode& episode, int transition);
  void UpdateOnce();
  void CopyToTarget();
  void MakeVersion();
  void Offer(NetworkKind kind, int32_t version, const Vector& parameters);
  void ForgetVersions();
  void CheckState(const TrainingState& state) const;
  void CheckProgress(const TrainingState& state) const;
  void CheckOrders(const TrainingState& state) const;
  void RefillReplay(const TrainingState& state);
  bool AllEpisodesCommitted() const { return progress_.episodes == experiment_.schedule().episodes(); }
  int64_t EvaluationsDue() const;
  void WriteFinalEvaluation();
  void WriteTrainingOrder();
  void WriteEvaluation();
  void WriteOrder(Order order);

  Experiment experiment_;
  const World* world_;
  TrainerOutput output_;
  int64_t expected_updates_;
  NetworkInput network_input_;
  ReplayMemory replay_;
  ActionHistory history_;  // of what is in the replay memory
  MiniBatch batch_;
  Dqn dqn_;
  std::vector<float> observation_;
  std::vector<float> next_observation_;
  std::vector<float> least_values_;  // of the episode's transitions
  TrainerProgress progress_;
  int64_t training_orders_ = 0;  // written
  std::deque<OrderInFlight> orders_;             // by index, from progress_.committed_orders on
  std::map<VersionKey, VersionState> versions_;  // those that orders_ name, and the newest
  std::optional<Evaluation> last_evaluation_;
  std::optional<BestNetwork> best_;
};

}  // namespace fresco
