#include "tests/training/literal_run.h"

#include <deque>
#include <map>

#include "training/flyer.h"

namespace fresco {

Experiment SmallExperiment(const Settings& settings) {
  return Experiment::Parse(R"(
      scenario {
        grid { columns: 5 rows: 5 } slots: 14
        start { column: 0 row: 0 } stop { column: 4 row: 4 }
        sensor { x_m: 0 y_m: 100 } sensor { x_m: 75 y_m: 25 weight: 2 }
        coverage_radius_m: 30
      }
      agent {
        hidden_layers: [16, 12] double_dqn: true safe_action_mask: true coverage_mask: true
        batch_size: 16 replay_capacity: 300 target_update_period: 20
        linear { initial: 1e-2 final: 1e-4 }
      }
      schedule {
        seed: 5 episodes: 60 inserts_per_update: 2 minimum_replay_size: 40 window: 6
        updates_per_version: 7 versions_per_evaluation: 4 ladder {}
      })",
                           "the small experiment", settings);
}

OrderResult FlyOrder(const World& world, const Experiment& experiment, const Order& order,
                     std::shared_ptr<const Vector> current, std::shared_ptr<const Vector> target) {
  Flyer flyer(world, experiment, 1);
  flyer.Start(order, std::move(current), std::move(target));
  OrderResult flown;
  while (!flyer.Idle()) {
    flyer.Step([&](const Order&, OrderResult& result) { flown = std::move(result); });
  }
  return flown;
}

OrderResult ResultOf(int64_t order_index, const Episode& episode) {
  return {order_index, 0, episode, std::vector<float>(episode.actions.size(), 0.0f)};
}

RunResult RunInOneLoop(const Experiment& experiment) {
  const World world(experiment.scenario());
  std::deque<Order> orders;
  std::map<NetworkVersion, std::shared_ptr<const Vector>> versions;
  RunResult result;
  TrainerOutput output;
  output.order = [&](const Order& order) { orders.push_back(order); };
  output.version = [&](NetworkVersion version, std::shared_ptr<const Vector> parameters) {
    versions[version] = std::move(parameters);
  };
  output.evaluation = [&](const Evaluation&) { ++result.evaluations; };
  Trainer trainer(experiment, world, output);
  trainer.Begin();
  while (!trainer.finished()) {
    const Order order = orders.front();
    orders.pop_front();
    trainer.Commit(
        order, FlyOrder(world, experiment, order, versions.at({NetworkKind::kCurrent, order.current_version}),
                        versions.at({NetworkKind::kTarget, order.target_version}))
                   .episode);
  }
  result.weights = trainer.current();
  result.updates = trainer.progress().updates;
  result.best_average_aoi = trainer.best()->evaluation.figures.average_aoi;
  return result;
}

OrderResult PartOf(const World& world, const OrderResult& result, int first, int count) {
  const Episode& all = result.episode;
  OrderResult part{result.order_index, first, {}, {}};
  const auto copy = [&](const auto& from, auto& to, int extra, int scale) {
    to.assign(from.begin() + first * scale, from.begin() + (first + count) * scale + extra);
  };
  part.episode.outcome = first + count == all.transitions() ? all.outcome : Outcome::kFlying;
  copy(all.states, part.episode.states, 1, 1);
  copy(all.actions, part.episode.actions, 0, 1);
  copy(all.rewards, part.episode.rewards, 0, 1);
  copy(result.td_errors, part.td_errors, 0, 1);
  copy(all.next_masks, part.episode.next_masks, 0, MaskSize(world));
  return part;
}

}  // namespace fresco
