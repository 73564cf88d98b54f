// Updates a second of the learner at the paper's sizes (batch 200, network 7-200-256-20), beside the
// roof: the same matrix products by Eigen and nothing else. The share of the roof is printed last.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <string>

#include "core/random.h"
#include "tests/bench/share_reporter.h"
#include "training/dqn.h"
#include "training/replay_memory.h"

namespace fresco {
namespace {

constexpr int kBatch = 200;
const std::vector<int> kLayers = {7, 200, 256, 20};

/// A replay memory of random transitions of the paper's shape.
ReplayMemory RandomMemory() {
  constexpr int kTransitions = 40000;
  ReplayMemory memory(kLayers.front(), kLayers.back(), kTransitions);
  RandomStream stream(1, RandomPurpose::kTest, 0, 0);
  std::vector<float> observation(static_cast<size_t>(kLayers.front()));
  std::vector<float> next_observation(observation.size());
  std::vector<uint8_t> mask((static_cast<size_t>(kLayers.back()) + 7) / 8);
  for (int i = 0; i < kTransitions; ++i) {
    for (size_t row = 0; row < observation.size(); ++row) {
      observation[row] = static_cast<float>(stream.NextUniform());
      next_observation[row] = static_cast<float>(stream.NextUniform());
    }
    for (uint8_t& bits : mask) {
      bits = static_cast<uint8_t>(stream.NextBelow(255) + 1);
    }
    memory.Insert({observation, next_observation, static_cast<int16_t>(stream.NextBelow(20)),
                   static_cast<float>(-stream.NextUniform()), stream.NextBelow(69) == 0, mask});
  }
  return memory;
}

/// One whole update as the learner makes it: sample, targets, forward, backward, Adam.
void Update(benchmark::State& state, bool double_dqn) {
  const ReplayMemory memory = RandomMemory();
  const MlpShape shape(kLayers);
  DqnOptions options;
  options.double_dqn = double_dqn;
  options.batch_size = kBatch;
  Dqn dqn(shape, InitialParameters(shape, 1), options, std::getenv("THREADS") ? atoi(std::getenv("THREADS")) : 1);
  MiniBatch batch(shape.inputs(), shape.outputs(), kBatch);
  uint32_t update = 0;
  for (auto _ : state) {
    RandomStream stream(1, RandomPurpose::kReplaySampling, update++, 0);
    memory.Sample(stream, batch);
    benchmark::DoNotOptimize(dqn.Update(batch, 1e-4));
  }
  state.counters["updates/s"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

/// The matrix products of one update: `forward_passes` forward, one backward without the gradient
/// with respect to the network's input.
void Products(benchmark::State& state, int forward_passes) {
  std::vector<Matrix> weights;
  std::vector<Matrix> activations = {Matrix::Random(kLayers[0], kBatch)};
  for (size_t layer = 0; layer + 1 < kLayers.size(); ++layer) {
    weights.push_back(Matrix::Random(kLayers[layer + 1], kLayers[layer]));
    activations.push_back(Matrix::Random(kLayers[layer + 1], kBatch));
  }
  std::vector<Matrix> weight_gradients = weights;
  std::vector<Matrix> gradients = activations;
  for (auto _ : state) {
    for (int pass = 0; pass < forward_passes; ++pass) {
      for (size_t layer = 0; layer < weights.size(); ++layer) {
        activations[layer + 1].noalias() = weights[layer] * activations[layer];
      }
    }
    for (size_t layer = weights.size(); layer-- > 0;) {
      weight_gradients[layer].noalias() = gradients[layer + 1] * activations[layer].transpose();
      if (layer > 0) {
        gradients[layer].noalias() = weights[layer].transpose() * gradients[layer + 1];
      }
    }
    benchmark::DoNotOptimize(weight_gradients[0].data());
    benchmark::ClobberMemory();
  }
  state.counters["updates/s"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

// Two forward passes: Q(s, a) and the target network in s'. Double DQN adds the current network in s'.
BENCHMARK_CAPTURE(Update, dqn, false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(Products, dqn, 2)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(Update, double_dqn, true)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(Products, double_dqn, 3)->Unit(benchmark::kMicrosecond);

void PrintShares(const BenchmarkSeconds& all) {
  for (const std::string name : {"dqn", "double_dqn"}) {
    const auto update = all.find("Update/" + name);
    const auto products = all.find("Products/" + name);
    if (update != all.end() && products != all.end()) {
      std::printf("%-10s: an update runs at %.0f %% of the speed of its matrix products alone\n",
                  name.c_str(), 100 * products->second / update->second);
    }
  }
}

}  // namespace
}  // namespace fresco

int main(int argc, char** argv) {
  return fresco::RunBenchmarks(argc, argv, fresco::PrintShares);
}
