#include "tests/training/literal_run.h"

#include <gtest/gtest.h>

#include <deque>
#include <map>
#include <utility>

#include "core/error.h"
#include "tests/worlds/test_scenarios.h"
#include "training/flyer.h"

namespace fresco {

namespace {

Experiment SmallFieldWith(const std::string& network, const Settings& settings) {
  return Experiment::Parse(R"(
      scenario {
        grid { columns: 5 rows: 5 } slots: 14
        start { column: 0 row: 0 } stop { column: 4 row: 4 }
        sensor { x_m: 0 y_m: 100 } sensor { x_m: 75 y_m: 25 weight: 2 }
        coverage_radius_m: 30
      }
      agent {)" + network +
                               R"(
        double_dqn: true safe_action_mask: true coverage_mask: true
        batch_size: 16 replay_capacity: 300 target_update_period: 20
        linear { initial: 1e-2 final: 1e-4 }
      }
      schedule {
        seed: 5 episodes: 60 inserts_per_update: 2 minimum_replay_size: 40 window: 6
        updates_per_version: 7 versions_per_evaluation: 4 ladder {}
      })",
                           "the small experiment", settings);
}

}  // namespace

Experiment SmallExperiment(const Settings& settings) {
  return SmallFieldWith("hidden_layers: [16, 12]", settings);
}

Experiment SmallSetExperiment(const Settings& settings) {
  return SmallFieldWith("set_network { encoder_layers: [16, 12] trunk_layers: 16 head_layers: 12 }",
                        settings);
}

Experiment SmallCartPole(const Settings& settings) {
  return Experiment::Parse(R"(
      cartpole { maximum_steps: 12 }
      agent {
        hidden_layers: [8] double_dqn: true batch_size: 16 replay_capacity: 150 target_update_period: 20
        linear { initial: 1e-2 final: 1e-4 }
      }
      schedule {
        seed: 5 episodes: 50 inserts_per_update: 2 minimum_replay_size: 40 window: 6
        updates_per_version: 7 versions_per_evaluation: 4 evaluation_episodes: 3 ladder { exponent: 2 }
      })",
                           "the small CartPole", settings);
}

OrderResult FlyOrder(const Experiment& experiment, const Order& order, std::shared_ptr<const Vector> current,
                     std::shared_ptr<const Vector> target) {
  Flyer flyer(experiment, 1);
  flyer.Start(order, std::move(current), std::move(target));
  OrderResult flown;
  while (!flyer.Idle()) {
    flyer.Step([&](const Order&, const OrderResult& result) { flown = result; });
  }
  return flown;
}

OrderResult ResultOf(const Order& order, const Episode& episode) {
  return {order.index, order.seed, 0, 0, episode, std::vector<float>(episode.actions.size(), 0.0f)};
}

RunResult RunInOneLoop(const Experiment& experiment) {
  std::deque<Order> orders;
  std::map<NetworkVersion, std::shared_ptr<const Vector>> versions;
  RunResult result;
  TrainerOutput output;
  output.order = [&](const Order& order) { orders.push_back(order); };
  output.version = [&](NetworkVersion version, std::shared_ptr<const Vector> parameters) {
    versions[version] = std::move(parameters);
  };
  output.evaluation = [&](const Evaluation&) { ++result.evaluations; };
  Trainer trainer(experiment, output);
  trainer.Begin();
  while (!trainer.finished()) {
    const Order order = orders.front();
    orders.pop_front();
    trainer.Commit(order,
                   FlyOrder(experiment, order, versions.at({NetworkKind::kCurrent, order.current_version}),
                            versions.at({NetworkKind::kTarget, order.target_version}))
                       .episode);
  }
  result.weights = trainer.current();
  result.updates = trainer.progress().updates;
  result.best_score = trainer.best()->evaluation.score();
  if (trainer.delivered()) {
    result.delivered_score = trainer.delivered()->score();
  }
  return result;
}

OrderResult PartOf(const World& world, const OrderResult& result, int first, int count) {
  const auto begin = result.td_errors.begin() + first;
  return {result.order_index,    result.seed, first, 0, PartOf(world, result.episode, first, count),
          {begin, begin + count}};
}

RecordedRun::RecordedRun(const Settings& settings) : RecordedRun(SmallExperiment(settings)) {}

RecordedRun::RecordedRun(const Experiment& the_experiment)
    : experiment(the_experiment), world(experiment.world()), trainer(experiment, Output()) {
  weights.push_back(trainer.current());
  trainer.Begin();
  orders_at_begin = orders.size();
}

TrainerOutput RecordedRun::Output() {
  TrainerOutput output;
  output.order = [this](const Order& order) { orders.push_back(order); };
  output.version = [this](NetworkVersion version, std::shared_ptr<const Vector> parameters) {
    auto& versions = version.kind == NetworkKind::kCurrent ? current_versions : target_versions;
    EXPECT_EQ(version.number, static_cast<int32_t>(versions.size())) << "versions come by their numbers";
    versions.push_back(std::move(parameters));
  };
  output.evaluation = [this](const Evaluation& evaluation) { evaluations.push_back(evaluation); };
  output.updated = [this] { weights.push_back(trainer.current()); };
  return output;
}

Episode RecordedRun::Fly(const Order& order) const {
  return FlyOrder(experiment, order, current_versions.at(static_cast<size_t>(order.current_version)),
                  target_versions.at(static_cast<size_t>(order.target_version)))
      .episode;
}

void RecordedRun::Commit(Episode episode) {
  constexpr size_t kEndless = 1000;  // orders; the small runs have fewer
  FRESCO_CHECK(episodes.size() < kEndless);
  const Order order = next();
  trainer.Commit(order, episode);
  episodes.push_back(std::move(episode));
  progress.push_back(trainer.progress());
  orders_written.push_back(orders.size());
}

void RecordedRun::Finish() {
  while (!trainer.finished()) {
    Commit(Fly(next()));
  }
}

}  // namespace fresco
