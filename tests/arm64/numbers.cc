// Prints numbers that have to be the same on every processor: the fingerprint of the arithmetic and, for each
// built-in world, the CRCs of episodes and of the weights that a Dqn learned from them. Exits with 1 if the
// arithmetics of this processor differ.
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "core/bytes.h"
#include "nn/arithmetic.h"
#include "nn/mlp.h"
#include "tests/worlds/test_scenarios.h"
#include "training/dqn.h"
#include "worlds/acrobot/acrobot.h"
#include "worlds/cartpole/cartpole.h"
#include "worlds/episode.h"
#include "worlds/uav/obstacle_map.h"
#include "worlds/uav/uav_fields.h"
#include "worlds/uav/uav_world.h"

namespace fresco {
namespace {

constexpr int kEpisodes = 10;
constexpr int kUpdates = 20;
constexpr int kBatchSize = 40;

/// Random episodes of a world, in a replay memory.
struct Experience {
  explicit Experience(const World& world)
      : memory(world.description().observation_size, world.actions(), 100'000) {
    for (uint32_t seed = 0; seed < kEpisodes; ++seed) {
      Add(world, seed);
    }
  }

  void Add(const World& world, uint32_t seed) {
    RandomStream stream(seed, RandomPurpose::kTest, 0, 0);
    EpisodeRecorder recorder(world, seed);
    std::vector<float> observation(static_cast<size_t>(world.description().observation_size));
    std::vector<float> next_observation(observation.size());
    world.Observe(recorder.state(), observation);
    while (!recorder.ended()) {
      recorder.Step(RandomAllowedAction(recorder.mask(), stream));
      world.Observe(recorder.state(), next_observation);
      std::vector<uint8_t> mask;
      AppendMask(recorder.mask(), mask);
      const Episode& episode = recorder.episode();
      memory.Insert({observation, next_observation, episode.actions.back(), episode.rewards.back(),
                     episode.ending == Ending::kTerminal ? 0.0f : 0.99f, mask});
      crc = Crc32c(std::as_bytes(std::span(next_observation)), crc);
      observation.swap(next_observation);
    }
    crc = Crc32c(std::as_bytes(std::span(recorder.episode().states)), crc);
    crc = Crc32c(std::as_bytes(std::span(recorder.episode().rewards)), crc);
  }

  ReplayMemory memory;
  uint32_t crc = 0;
};

std::string NumbersOf(const World& world) {
  const Experience experience(world);
  const auto network =
      std::make_shared<Mlp>(MlpShape({world.description().observation_size, 40, 32, world.actions()}));
  Dqn dqn(network, network->InitialParameters(1), {true, kBatchSize, {}}, 2);
  MiniBatch batch(network->inputs(), network->outputs(), kBatchSize);
  for (uint32_t update = 0; update < kUpdates; ++update) {
    RandomStream stream(1, RandomPurpose::kReplaySampling, update, 0);
    experience.memory.Sample(stream, batch);
    dqn.Update(batch, 1e-3);
    dqn.CopyToTarget();
  }
  char text[100];
  std::snprintf(text, sizeof text, "%s: episodes %08x, weights %08x\n", world.description().name.c_str(),
                experience.crc, Crc32c(Values(dqn.current())));
  return text;
}

/// Fields over a map, on which corners of houses are on lines between cells and sensors.
UavFields Town() {
  Scenario scenario = TableOneScenario();
  scenario.columns = scenario.rows = 6;
  scenario.start = scenario.stop = {0, 0};
  scenario.map = std::make_shared<ObstacleMap>(
      std::vector<std::string>{"....SS", ".BB.N.", ".BB.N.", "......", ".RRR..", "SS...."});
  return UavFields(scenario, {{1, 4}, {0.5, 2}, {30, 100}, {25, 30}, true, true}, {{true, true}, {}});
}

std::string Numbers() {
  Scenario scenario = TableOneScenario();
  scenario.rotor = LiteratureRotor();
  UavOptions options;
  options.network_input.sensor_geometry = true;
  return NumbersOf(CartPole(200)) + NumbersOf(Acrobot(200)) + NumbersOf(UavWorld(scenario, options)) +
         NumbersOf(Town());
}

int Main() {
  std::printf("arithmetic fingerprint %08x\n", ArithmeticFingerprint());
  const std::string expected = Numbers();
  std::printf("%s", expected.c_str());
  for (const Arithmetic* arithmetic : AvailableArithmetics()) {
    UseArithmetic(arithmetic->name);
    if (const std::string numbers = Numbers(); numbers != expected) {
      std::printf("%s differs:\n%s", arithmetic->name, numbers.c_str());
      return 1;
    }
  }
  return 0;
}

}  // namespace
}  // namespace fresco

int main() {
  return fresco::Main();
}
