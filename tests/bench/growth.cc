// How cost grows: the same work at several sizes, each beside the sizes of the default experiment.
//
// growth_batch_*, growth_width_*, growth_observation_*, growth_replay_*: transitions a second that updates
// learn from. growth_environments_*, growth_sensors_*: transitions a second of an actor. replay_bytes:
// resident memory that a transition takes in the replay memory.
#include <fmt/format.h>
#include <unistd.h>

#include <fstream>

#include "msgs/ready_experiments.h"
#include "nn/mlp.h"
#include "tests/bench/alternate.h"
#include "tests/bench/flying_actor.h"
#include "tests/bench/subjects.h"
#include "tests/bench/update_loop.h"

namespace fresco {
namespace {

/// The sizes of updates; the defaults are the paper's.
struct UpdateSizes {
  int batch = 200;
  std::vector<int> layers = {7, 200, 256, 20};
  int replay = 40'000;
};

Work Updates(const UpdateSizes& sizes) {
  DqnOptions options;
  options.batch_size = sizes.batch;
  const auto loop =
      std::make_shared<UpdateLoop>(std::make_shared<Mlp>(MlpShape(sizes.layers)), options, 1, sizes.replay);
  return [loop, batch = sizes.batch] {
    loop->Step();
    return static_cast<double>(batch);
  };
}

double ResidentBytes() {
  std::ifstream file("/proc/self/statm");
  double pages = 0;
  double resident_pages = 0;
  file >> pages >> resident_pages;
  return resident_pages * static_cast<double>(sysconf(_SC_PAGESIZE));
}

/// Of a replay memory with a million transitions of the paper's size.
Results ReplayBytes(double) {
  constexpr int kInputs = 7;
  constexpr int kActions = 20;
  constexpr int kTransitions = 1'000'000;
  const double before = ResidentBytes();
  ReplayMemory memory(kInputs, kActions, kTransitions);
  const std::vector<float> observation(kInputs, 0.5F);
  const std::vector<uint8_t> mask(static_cast<size_t>(MaskSize(kActions)), 1);
  for (int i = 0; i < kTransitions; ++i) {
    memory.Insert({observation, observation, 1, -0.5F, false, mask});
  }
  const double bytes = (ResidentBytes() - before) / kTransitions;
  constexpr double kFields = 2 * kInputs * 4 + 2 + 2 * 4 + 1 + 3;  // s, s', action, reward, bound, end, mask
  return {{LessIsBetter("replay_bytes", bytes, "B/transition", "its fields alone", kFields)}, {}};
}

/// The sizes of an actor; 0: that of the default experiment.
struct ActorSizes {
  int environments = 0;
  int sensors = 0;
};

Work Flights(const ActorSizes& sizes) {
  proto::ExperimentConfig config = Experiment::Load(ExperimentPath(kDefaultExperiment)).config();
  if (sizes.environments > 0) {
    config.mutable_run()->set_environments_per_actor(sizes.environments);
  }
  if (sizes.sensors > 0) {
    config.mutable_scenario()->clear_sensor();
    config.mutable_scenario()->mutable_random_sensors()->set_count(sizes.sensors);
  }
  struct Actor {
    explicit Actor(const proto::ExperimentConfig& config)
        : experiment(Experiment::Make(config, "the benchmark")), flying(experiment) {}
    Experiment experiment;
    FlyingActor flying;
  };
  const auto actor = std::make_shared<Actor>(config);
  return [actor] { return actor->flying.Fly(); };
}

/// A subject with one row, beside the usual sizes.
Subject Grown(const std::string& name, const std::string& usual_sizes, const std::function<Work()>& grown,
              const std::function<Work()>& usual) {
  return {{name}, [=](double seconds) -> Results {
            const Speeds speeds = Alternate(grown(), {usual()}, seconds);
            return {
                {MoreIsBetter(name, speeds.value, "transitions/s", usual_sizes, speeds.references.front())},
                {}};
          }};
}

Subject GrownUpdates(const std::string& name, const UpdateSizes& sizes) {
  return Grown(
      name, "batch 200, network 7-200-256-20, 40,000 transitions held", [=] { return Updates(sizes); },
      [] { return Updates({}); });
}

Subject GrownFlights(const std::string& name, const ActorSizes& sizes) {
  return Grown(
      name, "16 environments, 3 sensors", [=] { return Flights(sizes); }, [] { return Flights({}); });
}

}  // namespace

std::vector<Subject> GrowthSubjects() {
  std::vector<Subject> subjects = {{{"replay_bytes"}, ReplayBytes}};
  for (const int batch : {16, 64, 800, 3200}) {
    subjects.push_back(GrownUpdates(fmt::format("growth_batch_{}", batch), {.batch = batch}));
  }
  for (const int width : {64, 128, 512, 1024}) {
    subjects.push_back(
        GrownUpdates(fmt::format("growth_width_{}", width), {.layers = {7, width, width, 20}}));
  }
  for (const int observation : {32, 128, 512}) {
    subjects.push_back(GrownUpdates(fmt::format("growth_observation_{}", observation),
                                    {.layers = {observation, 200, 256, 20}}));
  }
  for (const int replay : {400'000, 10'000'000}) {
    subjects.push_back(GrownUpdates(fmt::format("growth_replay_{}", replay), {.replay = replay}));
  }
  for (const int environments : {1, 4, 64, 256}) {
    subjects.push_back(
        GrownFlights(fmt::format("growth_environments_{}", environments), {.environments = environments}));
  }
  for (const int sensors : {1, 10, 30, 100}) {
    subjects.push_back(GrownFlights(fmt::format("growth_sensors_{}", sensors), {.sensors = sensors}));
  }
  return subjects;
}

}  // namespace fresco
