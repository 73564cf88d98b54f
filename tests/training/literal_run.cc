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

Episode FlyOrder(const World& world, const Experiment& experiment, const Order& order,
                 std::shared_ptr<const Vector> current, std::shared_ptr<const Vector> target) {
  Flyer flyer(world, experiment, 1);
  flyer.Start(order, std::move(current), std::move(target));
  Episode flown;
  while (!flyer.Idle()) {
    flyer.Step([&](const Order&, const Episode& episode) { flown = episode; });
  }
  return flown;
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
                        versions.at({NetworkKind::kTarget, order.target_version})));
  }
  result.weights = trainer.current();
  result.updates = trainer.progress().updates;
  result.best_average_aoi = trainer.best()->evaluation.figures.average_aoi;
  return result;
}

Episode PartOf(const World& world, const Episode& episode, int first, int count) {
  Episode run;
  const auto part = [&](const auto& from, auto& to, int extra, int scale) {
    to.assign(from.begin() + first * scale, from.begin() + (first + count) * scale + extra);
  };
  run.order_index = episode.order_index;
  run.first_transition = first;
  run.outcome = first + count == episode.transitions() ? episode.outcome : Outcome::kFlying;
  part(episode.states, run.states, 1, 1);
  part(episode.actions, run.actions, 0, 1);
  part(episode.rewards, run.rewards, 0, 1);
  part(episode.td_errors, run.td_errors, 0, 1);
  part(episode.next_masks, run.next_masks, 0, MaskSize(world));
  return run;
}

}  // namespace fresco
