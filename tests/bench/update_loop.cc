#include "tests/bench/update_loop.h"

#include <vector>

namespace fresco {
UpdateLoop::UpdateLoop(std::shared_ptr<const Network> network, const DqnOptions& options, int threads,
                       int transitions)
    : memory_(network->inputs(), network->outputs(), transitions),
      dqn_(network, network->InitialParameters(1), options, threads),
      batch_(network->inputs(), network->outputs(), options.batch_size) {
  RandomStream stream(1, RandomPurpose::kTest, 0, 0);
  std::vector<float> observation(static_cast<size_t>(network->inputs()));
  std::vector<float> next_observation(observation.size());
  std::vector<uint8_t> mask(static_cast<size_t>(MaskSize(network->outputs())));
  for (int i = 0; i < transitions; ++i) {
    for (size_t row = 0; row < observation.size(); ++row) {
      observation[row] = static_cast<float>(stream.NextUniform());
      next_observation[row] = static_cast<float>(stream.NextUniform());
    }
    for (uint8_t& bits : mask) {
      bits = static_cast<uint8_t>(stream.NextBelow(255) + 1);
    }
    memory_.Insert({observation, next_observation,
                    static_cast<int16_t>(stream.NextBelow(static_cast<uint32_t>(network->outputs()))),
                    static_cast<float>(-stream.NextUniform()), stream.NextBelow(69) == 0 ? 0.0f : 1.0f,
                    mask});
  }
}

void UpdateLoop::Step() {
  RandomStream stream(1, RandomPurpose::kReplaySampling, updates_++, 0);
  memory_.Sample(stream, batch_);
  dqn_.Update(batch_, 1e-4);
}

}  // namespace fresco
