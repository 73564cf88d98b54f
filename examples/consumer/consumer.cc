// Uses Fresco as libraries: plans the best flight of an experiment, judges it, and asks an untrained network
// what it would do first. `consumer /usr/share/fresco/configs/ci.textproto` prints
//   average_aoi 13.281
//   ...
#include <cstdio>
#include <exception>
#include <vector>

#include "core/error.h"
#include "fresco/flight_t.hpp"
#include "msgs/experiment.h"
#include "msgs/worlds.h"
#include "nn/network.h"
#include "planner/planner.h"

namespace {

using namespace fresco;

/// Returns the action that the experiment's network, as it is before the training, prefers in a state.
int FirstChoice(const Experiment& experiment, std::span<const float> state) {
  const Network& network = *experiment.network();
  const auto workspace = network.NewWorkspace(1, NetworkWorkspace::Passes::kForward);
  Matrix& input = workspace->input();
  experiment.world().Observe(state, {input.data(), static_cast<size_t>(network.inputs())});
  network.Forward(Values(experiment.FirstParameters()), {0, 1}, *workspace);
  Eigen::Index best = 0;
  workspace->output().col(0).head(network.outputs()).maxCoeff(&best);
  return static_cast<int>(best);
}

void Show(const Experiment& experiment) {
  const World& world = experiment.world();
  if (!CanPlan(world)) {
    throw UsageError("expected a UAV's experiment, whose optimum is known, found " +
                     world.description().name);
  }
  const Episode flight = PlanOptimally(world, 0).flight;
  std::vector<double> figures(world.description().figures.size());
  world.Judge(flight, figures);
  for (size_t i = 0; i < figures.size(); ++i) {
    std::printf("%s %.3f\n", world.description().figures[i].name.c_str(), figures[i]);
  }
  const std::vector<flight_t> messages = FlightMessages(experiment, flight, "optimal");
  std::printf("messages %zu\n", messages.size());
  std::printf("untrained %s\n",
              world.description().actions[FirstChoice(experiment, flight.state(0))].c_str());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: consumer EXPERIMENT.textproto\n");
    return 2;
  }
  try {
    Show(Experiment::Load(argv[1]));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "consumer: %s\n", error.what());
    return 1;
  }
}
