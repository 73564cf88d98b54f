// Updates as the learner makes them, without anything else: sample from the replay memory, targets, forward,
// backward, Adam. Not thread-safe.
#pragma once

#include <cstdint>
#include <memory>

#include "training/dqn.h"
#include "training/replay_memory.h"

namespace fresco {

class UpdateLoop {
 public:
  /// Fills a replay memory of so many random transitions. `network` has at least 8 outputs.
  UpdateLoop(std::shared_ptr<const Network> network, const DqnOptions& options, int threads = 1,
             int transitions = 40'000);

  /// Makes one update.
  void Step();

 private:
  ReplayMemory memory_;
  Dqn dqn_;
  MiniBatch batch_;
  uint32_t updates_ = 0;
};

}  // namespace fresco
