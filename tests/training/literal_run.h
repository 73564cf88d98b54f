// Small runs for tests: an experiment of a second, and what follows from it if one thread flies every order
// at once, without a bus.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "msgs/experiment.h"
#include "training/trainer.h"

namespace fresco {

/// A small field (5 x 5 cells, two sensors) and a small network.
Experiment SmallExperiment(const Settings& settings = {});

/// The same field with a network for sets.
Experiment SmallSetExperiment(const Settings& settings = {});

/// CartPole of twelve steps at most, with a tiny network. Random episodes are about as long, so some are cut
/// off and some are not; every evaluation has three of them.
Experiment SmallCartPole(const Settings& settings = {});

/// The complete result of an order, flown alone.
OrderResult FlyOrder(const Experiment& experiment, const Order& order, std::shared_ptr<const Vector> current,
                     std::shared_ptr<const Vector> target);

/// The result of the order whose episode this is, with temporal-difference errors of 0.
OrderResult ResultOf(const Order& order, const Episode& episode);

/// What a run ends with.
struct RunResult {
  Vector weights;
  int64_t updates = 0;
  int64_t evaluations = 0;
  double best_score = 0;
  std::optional<double> delivered_score;  ///< only where chance decides
};

/// Trainer and flyer in one loop: the reference that every distributed run must equal.
RunResult RunInOneLoop(const Experiment& experiment);

/// Transitions [first, first + count) of a result, as a message carries them if states are not too long.
OrderResult PartOf(const World& world, const OrderResult& result, int first, int count);

/// A run, usually the small one, with everything that its trainer handed out, and where it stood after every
/// commit, so that a test can hold it against what the schedule says.
class RecordedRun {
 public:
  /// The small experiment with these settings; Begin was called.
  explicit RecordedRun(const Settings& settings = {});
  /// The same with any experiment.
  explicit RecordedRun(const Experiment& the_experiment);
  RecordedRun(const RecordedRun&) = delete;
  RecordedRun& operator=(const RecordedRun&) = delete;

  /// The next order to commit.
  const Order& next() const { return orders.at(episodes.size()); }
  /// The episode of an order, flown with the versions that it names.
  Episode Fly(const Order& order) const;
  /// Commits `episode` as the result of the next order.
  void Commit(Episode episode);
  /// Flies and commits to the end.
  void Finish();

  // By order index.
  std::vector<Order> orders;
  std::vector<Episode> episodes;
  std::vector<TrainerProgress> progress;  ///< after the commit
  std::vector<size_t> orders_written;     ///< after the commit
  size_t orders_at_begin = 0;

  std::vector<std::shared_ptr<const Vector>> current_versions;
  std::vector<std::shared_ptr<const Vector>> target_versions;
  std::vector<Vector> weights;  ///< by updates made; the first are those before any update
  std::vector<Evaluation> evaluations;

  const Experiment experiment;
  const World& world;
  Trainer trainer;

 private:
  TrainerOutput Output();
};

/// A run from its first order to its last.
struct FinishedRun : RecordedRun {
  explicit FinishedRun(const Settings& settings = {}) : RecordedRun(settings) { Finish(); }
  explicit FinishedRun(const Experiment& the_experiment) : RecordedRun(the_experiment) { Finish(); }
};

}  // namespace fresco
