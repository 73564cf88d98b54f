// Transitions a second of an actor's whole work but the bus's socket: flights of the quick experiment in as
// many environments as an actor has, with exploration, masks, temporal-difference errors, and the encoded
// messages.
//
// The roof is the forward passes alone, of the current and the target network at the width of all
// environments.
#include "core/clock.h"
#include "msgs/message_bus.h"
#include "msgs/order.h"
#include "msgs/ready_experiments.h"
#include "tests/bench/alternate.h"
#include "tests/bench/subjects.h"
#include "training/flyer.h"

namespace fresco {
namespace {

/// An actor's work, with the same two networks in every order.
class FlyingActor {
 public:
  FlyingActor(const Experiment& experiment, SharedParameters parameters)
      : experiment_(&experiment),
        parameters_(std::move(parameters)),
        flyer_(experiment, experiment.run().environments_per_actor()) {}

  /// Flies until as many episodes have ended as there are environments; returns their transitions. Starts the
  /// next one wherever one has ended.
  double Fly() {
    double transitions = 0;
    for (int ended = 0; ended < experiment_->run().environments_per_actor();) {
      while (flyer_.HasRoom()) {
        Order order;
        order.index = next_index_++;
        order.epsilon = 0.3;  // about the mean of the ladder
        order.seed = static_cast<uint64_t>(order.index);
        flyer_.Start(order, parameters_, parameters_);
      }
      flyer_.Step([&](const Order&, OrderResult& result) {
        ++ended;
        transitions += result.episode.transitions();
        SplitResult(experiment_->world(), result, 1, [&](transitions_t message) {
          Stamp(message, {1, experiment_->hash()}, WallMicroseconds());
          Encode(message, bytes_);
        });
      });
    }
    return transitions;
  }

 private:
  const Experiment* experiment_;
  SharedParameters parameters_;
  Flyer flyer_;
  int64_t next_index_ = 0;
  std::vector<std::byte> bytes_;
};

Results ActorBesideRoof(double seconds) {
  const Experiment experiment = Experiment::Load(ExperimentPath(kDefaultExperiment));
  const MlpShape shape = experiment.network_shape();
  const auto parameters =
      std::make_shared<const Vector>(InitialParameters(shape, experiment.schedule().seed()));
  FlyingActor actor(experiment, parameters);
  const int width = experiment.run().environments_per_actor();
  const Mlp mlp(shape);
  MlpWorkspace current(shape, width);
  MlpWorkspace target(shape, width);
  current.input().setRandom();
  target.input() = current.input();
  constexpr int kPassesPerCall = 20;
  const Speeds speeds = Alternate([&] { return actor.Fly(); }, {[&] {
                                    for (int i = 0; i < kPassesPerCall; ++i) {
                                      mlp.Forward(Values(*parameters), {0, width}, current);
                                      mlp.Forward(Values(*parameters), {0, width}, target);
                                    }
                                    return static_cast<double>(kPassesPerCall * width);
                                  }},
                                  seconds);
  return {
      {MoreIsBetter("actor_roof", speeds.value, "transitions/s",
                    "its two forward passes alone, as wide as its environments", speeds.references.front())},
      {}};
}

}  // namespace

std::vector<Subject> ActorSubjects() {
  return {{{"actor_roof"}, ActorBesideRoof}};
}

}  // namespace fresco
