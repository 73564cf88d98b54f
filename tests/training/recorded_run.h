// The small run with everything that its trainer handed out noted down, and where it stood after
// every commit, so that a test can hold it against what the schedule says.
#pragma once

#include <memory>
#include <vector>

#include "tests/training/literal_run.h"
#include "training/trainer.h"

namespace fresco {

class RecordedRun {
 public:
  /// The small experiment with these settings; Begin was called.
  explicit RecordedRun(const Settings& settings = {});
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
  const World world;
  Trainer trainer;

 private:
  TrainerOutput Output();
};

}  // namespace fresco
