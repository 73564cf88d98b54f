// Small runs for tests: an experiment of a second, and the weights that follow from it when one
// thread flies every order at once, without a bus.
#pragma once

#include <string>

#include "msgs/experiment.h"
#include "training/trainer.h"

namespace fresco {

/// A small field (5 x 5 cells, two sensors) and a small network.
Experiment SmallExperiment(const Settings& settings = {});

/// The complete result of an order, flown alone.
OrderResult FlyOrder(const World& world, const Experiment& experiment, const Order& order,
                     std::shared_ptr<const Vector> current, std::shared_ptr<const Vector> target);

/// The result whose episode this is, with temporal-difference errors of 0.
OrderResult ResultOf(int64_t order_index, const Episode& episode);

/// What a run ends with.
struct RunResult {
  Vector weights;
  int64_t updates = 0;
  int64_t evaluations = 0;
  double best_average_aoi = 0;
};

/// Trainer and flyer in one loop: the reference that every distributed run must equal.
RunResult RunInOneLoop(const Experiment& experiment);

/// Transitions [first, first + count) of a result, as a message carries them.
OrderResult PartOf(const World& world, const OrderResult& result, int first, int count);

}  // namespace fresco
