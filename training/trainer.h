// The trainer is the deterministic part of the learner. It commits episodes in the order of their indices;
// these alone decide every update, every network version, every further order and the final weights. It uses
// no bus, no clock and no actor. The learner's training thread owns it. Not thread-safe.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "msgs/experiment.h"
#include "msgs/order.h"
#include "training/dqn.h"
#include "training/replay_memory.h"
#include "training/training_state.h"

namespace fresco {

/// The functions to which the trainer hands its results. Begin, Resume and Commit call them, on the
/// thread that called these.
struct TrainerOutput {
  /// Receives a new order.
  std::function<void(const Order&)> order;
  /// Receives a new version of a network.
  std::function<void(NetworkVersion, std::shared_ptr<const Vector>)> version;
  /// Receives the result of an evaluation.
  std::function<void(const Evaluation&)> evaluation;
  /// Called after every update, to report progress; may be empty.
  std::function<void()> updated;
};

/// The threads that share an update: run.learner_threads, or as many as that stands for on this machine.
int LearnerThreads(const proto::Run& run);

class Trainer {
 public:
  /// `threads` (>= 1) share each update; their number changes no bit. Throws as Experiment::FirstParameters
  /// does.
  Trainer(const Experiment& experiment, TrainerOutput output, int threads = 1);

  /// Starts a new training: hands out version 0 of both networks and the first orders. Call either Begin or
  /// Resume, and only once.
  void Begin();

  /// Continues from `state`: hands out its versions and its orders again. Throws Failure if the state
  /// contradicts the experiment; the trainer can't be used after that.
  void Resume(const TrainingState& state);

  /// Returns the state from which Resume can continue. Copies four parameter vectors; shares the rest.
  TrainingState Save() const;

  /// Commits the episode of `order`: inserts its transitions and makes the updates that are due. CHECKs that
  /// `order` is the oldest one that is not committed. The caller has checked that the episode is complete and
  /// follows from its actions.
  void Commit(const Order& order, Episode episode);

  /// Whether every training episode is committed and the final version is evaluated.
  bool finished() const { return AllEpisodesCommitted() && orders_.empty(); }

  const TrainerProgress& progress() const { return progress_; }
  const Vector& current() const { return dqn_.current(); }
  const std::optional<BestNetwork>& best() const { return best_; }
  const std::optional<Evaluation>& last_evaluation() const { return last_evaluation_; }
  /// The score of the best version by episodes that did not choose it. None before the end, and in a world
  /// without chance, where best() has the exact score.
  const std::optional<Evaluation>& delivered() const { return delivered_; }

 private:
  void CommitTraining(Episode episode);
  void CommitEvaluation(const Order& order, const Episode& episode);
  void CompleteEvaluation(const Order& order);
  bool IsBetter(const Evaluation& a, const Evaluation& b) const;
  void ComputeLeastValues(const Episode& episode);
  void BeginInserting(const Episode& episode, int transition);
  void Observe(const Episode& episode, int state);
  std::span<float> Observation(int state) {
    return observations_[static_cast<size_t>(state) % observations_.size()];
  }
  void Insert(const Episode& episode, int transition);
  void UpdateOnce();
  void CopyToTarget();
  void MakeVersion();
  void Offer(NetworkVersion version, const Vector& parameters);
  void ForgetVersions();
  void CheckState(const TrainingState& state) const;
  void CheckProgress(const TrainingState& state) const;
  void CheckOrders(const TrainingState& state) const;
  void CheckEvaluations(const TrainingState& state) const;
  bool Fits(const Episode& episode) const;
  void RefillReplay(const TrainingState& state);
  bool AllEpisodesCommitted() const { return progress_.episodes == experiment_.schedule().episodes(); }
  int64_t EvaluationsDue() const;
  void WriteFinalEvaluation();
  void DeliverBest();
  void WriteTrainingOrder();
  void WriteEvaluation();
  void WriteOrder(Order order);

  Experiment experiment_;
  TrainerOutput output_;
  int64_t expected_updates_;
  ReplayMemory replay_;
  EpisodeHistory history_;  // the episodes whose transitions are in the replay memory
  MiniBatch batch_;
  Dqn dqn_;
  std::vector<std::vector<float>> observations_;  // a ring of those of the latest states
  std::vector<float> least_values_;               // lower bounds of Q*, by transition of the episode
  TrainerProgress progress_;
  int64_t training_orders_ = 0;       // training orders written so far
  int64_t evaluation_orders_ = 0;     // evaluation orders written so far
  std::deque<OrderInFlight> orders_;  // sorted by index, from progress_.committed_orders on
  std::map<NetworkVersion, VersionState>
      versions_;  // those that orders_ name, and the newest of each network
  PartialEvaluation partial_evaluation_;
  std::optional<Evaluation> last_evaluation_;
  std::optional<BestNetwork> best_;
  std::optional<Evaluation> delivered_;
};

}  // namespace fresco
