#include "storage/trained_policy.h"

#include "core/error.h"
#include "storage/policy.h"
#include "training/dqn.h"

namespace fresco {

TrainedPolicy::TrainedPolicy(const std::string& policy)
    : network_(ReadTrainedNetwork(policy, "policy")),
      workspace_(network_.experiment.network()->NewWorkspace(1, NetworkWorkspace::Passes::kForward)),
      state_(static_cast<size_t>(world().state_size())),
      mask_(static_cast<size_t>(world().actions())) {}

int TrainedPolicy::Act(const Environment& environment) {
  environment.WriteState(state_);
  environment.WriteMask(mask_);
  return Act(state_, mask_);
}

int TrainedPolicy::Act(std::span<const float> state, std::span<const uint8_t> mask) {
  FRESCO_CHECK(state.size() == state_.size() && mask.size() == mask_.size());
  Matrix& input = workspace_->input();
  world().Observe(state, {input.data(), static_cast<size_t>(world().observation_size())});
  network_.experiment.network()->Forward(Values(network_.parameters), {0, 1}, *workspace_);
  return GreedyAction(workspace_->output(), 0, mask);
}

std::span<const float> TrainedPolicy::values() const {
  return {workspace_->output().data(), mask_.size()};
}

}  // namespace fresco
