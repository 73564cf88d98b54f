#include "tests/training/recorded_run.h"

#include <gtest/gtest.h>

#include <utility>

#include "core/error.h"

namespace fresco {

RecordedRun::RecordedRun(const Settings& settings)
    : experiment(SmallExperiment(settings)),
      world(experiment.scenario()),
      trainer(experiment, world, Output()) {
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
  return FlyOrder(world, experiment, order, current_versions.at(static_cast<size_t>(order.current_version)),
                  target_versions.at(static_cast<size_t>(order.target_version)))
      .episode;
}

void RecordedRun::Commit(Episode episode) {
  constexpr size_t kEndless = 1000;  // orders; a run of 60 episodes has fewer
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
