// Transitions a second of an actor's whole work but the bus's socket: flights of the quick experiment in as
// many environments as an actor has.
//
// The roof is the forward passes alone, of the current and the target network at the width of all
// environments.
//
// message_bytes: what these messages take on the wire, without the headers of UDP and LCM.
#include "msgs/ready_experiments.h"
#include "nn/mlp.h"
#include "tests/bench/alternate.h"
#include "tests/bench/flying_actor.h"
#include "tests/bench/subjects.h"

namespace fresco {
namespace {

Results ActorBesideRoof(double seconds) {
  const Experiment experiment = Experiment::Load(ExperimentPath(kDefaultExperiment));
  const Network& network = *experiment.network();
  FlyingActor actor(experiment);
  const int width = experiment.run().environments_per_actor();
  const auto current = network.NewWorkspace(width, NetworkWorkspace::Passes::kForward);
  const auto target = network.NewWorkspace(width, NetworkWorkspace::Passes::kForward);
  current->input().setRandom();
  target->input() = current->input();
  constexpr int kPassesPerCall = 20;
  const Speeds speeds = Alternate([&] { return actor.Fly(); }, {[&] {
                                    for (int i = 0; i < kPassesPerCall; ++i) {
                                      network.Forward(Values(actor.parameters()), {0, width}, *current);
                                      network.Forward(Values(actor.parameters()), {0, width}, *target);
                                    }
                                    return static_cast<double>(kPassesPerCall * width);
                                  }},
                                  seconds);
  return {
      {MoreIsBetter("actor_roof", speeds.value, "transitions/s",
                    "its two forward passes alone, as wide as its environments", speeds.references.front())},
      {}};
}

Results MessageBytes(double) {
  const Experiment experiment = Experiment::Load(ExperimentPath(kDefaultExperiment));
  FlyingActor actor(experiment);
  actor.Fly();
  const World& world = experiment.world();
  const auto payload =
      static_cast<double>(static_cast<size_t>(world.state_size()) * sizeof(float) + sizeof(int16_t) +
                          sizeof(float) + static_cast<size_t>(MaskSize(world.actions())));
  return {{LessIsBetter("message_bytes", actor.bytes_per_transition(), "B/transition",
                        "state, action, reward and mask alone", payload)},
          {}};
}

}  // namespace

std::vector<Subject> ActorSubjects() {
  return {{{"actor_roof"}, ActorBesideRoof}, {{"message_bytes"}, MessageBytes}};
}

}  // namespace fresco
