// Trains from the episodes in LCM event logs instead of from actors, with the same trainer as a live run.
// Only one thread may use an object.
//
// With the recorded configuration, each order gets its own recorded episode; if the logs miss it, the episode
// is flown again. An episode is a pure function of its order, so the result is that of the live run. With
// another configuration in the same world, the recorded training episodes are experience for another
// agent: its n-th training order gets the n-th of them, whatever network flew it. Its evaluations are flown
// with its own networks.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "logs/logged_episodes.h"
#include "training/flyer.h"
#include "training/trainer.h"

namespace fresco {

class Retraining {
 public:
  enum class Use {
    kSameRun,     ///< the logs contain a run of exactly this configuration
    kExperience,  ///< the logs contain the run of another agent in this world
  };

  struct Counts {
    int64_t recorded_episodes = 0;   ///< recorded episodes used for an order
    int64_t flown_again = 0;         ///< orders whose episode the logs miss; always 0 with kExperience
    int64_t evaluations_flown = 0;   ///< evaluations flown; always 0 with kSameRun
    int64_t left_out = 0;            ///< recorded episodes that this agent's masks forbid
    int64_t compared_versions = 0;   ///< network versions compared with the CRCs in the logs; for kSameRun
    int64_t different_versions = 0;  ///< those that differ; 0 with the same binary on the same kind of
                                     ///< processor
    int32_t first_different_version = -1;  ///< -1: none
  };

  using EvaluationHandler = std::function<void(const Trainer& trainer, const Evaluation& evaluation)>;

  /// `episodes` must outlive the object. `evaluated` is called for every evaluation. If `strict`
  /// is set, the constructor and Step throw Failure if the logs miss an episode. The constructor throws
  /// UsageError if the logs contain too few training episodes (kExperience).
  Retraining(const Experiment& experiment, LoggedEpisodes& episodes, Use use, bool strict,
             EvaluationHandler evaluated);

  /// Commits the next order. Returns false if there is none left.
  bool Step();

  const Trainer& trainer() const { return trainer_; }
  const Counts& counts() const { return counts_; }

 private:
  struct PendingOrder {
    Order order;
    bool is_flown;  // true: this object flies it; false: it gets a recorded episode
    std::optional<Episode> flown = {};
  };

  TrainerOutput Output(EvaluationHandler evaluated);
  void AddOrder(const Order& order);
  void KeepVersion(NetworkKind kind, int32_t version, std::shared_ptr<const Vector> parameters);
  bool IsRecorded(const Order& order) const;
  Episode EpisodeOf(const PendingOrder& pending);
  Episode WaitForFlight(const PendingOrder& pending);
  Episode NextExperience();

  Experiment experiment_;
  LoggedEpisodes* episodes_;
  Use use_;
  bool strict_;
  std::deque<int64_t> experience_;  // kExperience: recorded training episodes that are not used yet
  SharedParameters current_;        // newest version, which a new order names
  SharedParameters target_;
  Flyer flyer_;
  std::deque<PendingOrder> pending_;  // sorted by index
  Counts counts_;
  Trainer trainer_;
};

}  // namespace fresco
