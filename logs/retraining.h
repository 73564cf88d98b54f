// Trains from the episodes that LCM event logs hold instead of from actors, with the same trainer as a live
// run. Belongs to one thread.
//
// With the configuration that was recorded every order is served by its own episode, or flown again where
// the logs miss it, and everything that follows is what the live run had: an episode is a pure function of
// its order. With another configuration in the same scenario the recorded training episodes serve as
// experience for another agent: its n-th training order is served by the n-th of them, whatever network flew
// it, and its evaluations are flown with its own networks.
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
    kSameRun,     ///< the logs hold a run of this very configuration
    kExperience,  ///< they hold another agent's, in this scenario
  };

  struct Counts {
    int64_t recorded_episodes = 0;   ///< that served an order
    int64_t flown_again = 0;         ///< orders whose episode the logs miss; always 0 with kExperience
    int64_t evaluations_flown = 0;   ///< with kExperience
    int64_t left_out = 0;            ///< recorded episodes that this agent's masks do not allow
    int64_t compared_versions = 0;   ///< of both networks, with the CRC that the logs hold; kSameRun
    int64_t different_versions = 0;  ///< of these; with the same binary none
    int32_t first_different_version = -1;
  };

  using EvaluationHandler = std::function<void(const Trainer& trainer, const Evaluation& evaluation)>;

  /// All must outlive it. `evaluated` is called for every evaluation. With `strict`, Run throws Failure where
  /// the logs miss an episode. Throws UsageError where the logs hold too few training episodes (kExperience).
  Retraining(const Experiment& experiment, const World& world, LoggedEpisodes& episodes, Use use, bool strict,
             EvaluationHandler evaluated);

  /// Commits the next order. Returns false once there is none.
  bool Step();

  const Trainer& trainer() const { return trainer_; }
  const Counts& counts() const { return counts_; }

 private:
  struct PendingOrder {
    Order order;
    bool is_flown;  // here; otherwise a recorded episode serves it
    std::optional<Episode> flown = {};
  };

  TrainerOutput Output(EvaluationHandler evaluated);
  void TakeOrder(const Order& order);
  void TakeVersion(NetworkKind kind, int32_t version, std::shared_ptr<const Vector> parameters);
  bool IsRecorded(const Order& order) const;
  Episode EpisodeOf(const PendingOrder& pending);
  Episode WaitForFlight(const PendingOrder& pending);
  Episode NextExperience(int64_t order_index);

  Experiment experiment_;
  const World* world_;
  LoggedEpisodes* episodes_;
  Use use_;
  bool strict_;
  std::deque<int64_t> experience_;  // kExperience: recorded training episodes that have served no order yet
  SharedParameters current_;        // the newest versions, which every order names as it is written
  SharedParameters target_;
  Flyer flyer_;
  std::deque<PendingOrder> pending_;  // by index
  Counts counts_;
  Trainer trainer_;
};

}  // namespace fresco
