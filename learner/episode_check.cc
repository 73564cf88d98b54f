#include "learner/episode_check.h"

#include <cstring>

namespace fresco {
namespace {

bool SameState(const State& a, const State& b) {
  return a.slot == b.slot && a.cell == b.cell && a.time_margin == b.time_margin &&
         std::memcmp(&a.energy_margin_j, &b.energy_margin_j, sizeof a.energy_margin_j) == 0 && a.aoi == b.aoi;
}

bool SameMask(const std::vector<uint8_t>& mask, const uint8_t* packed) {
  for (size_t action = 0; action < mask.size(); ++action) {
    if (((packed[action / 8] >> (action % 8)) & 1) != mask[action]) {
      return false;
    }
  }
  return true;
}

}  // namespace

bool FollowsFromItsActions(const World& world, MaskOptions mask_options, const Episode& episode) {
  Environment environment(world);
  environment.Reset();
  std::vector<uint8_t> mask(static_cast<size_t>(world.actions()));
  environment.WriteMask(mask_options, mask);
  if (episode.states.empty() || !SameState(environment.state(), episode.states.front())) {
    return false;
  }
  const auto mask_size = static_cast<size_t>(MaskSize(world));
  for (size_t i = 0; i < episode.actions.size(); ++i) {
    const auto action = static_cast<size_t>(episode.actions[i]);
    if (environment.outcome() != Outcome::kFlying || mask[action] == 0) {
      return false;
    }
    const StepResult result = environment.Step(world.ActionAt(static_cast<int>(action)));
    environment.WriteMask(mask_options, mask);
    if (static_cast<float>(result.reward) != episode.rewards[i] ||
        !SameState(environment.state(), episode.states[i + 1]) ||
        !SameMask(mask, episode.next_masks.data() + i * mask_size)) {
      return false;
    }
  }
  return environment.outcome() == episode.outcome && episode.outcome != Outcome::kFlying;
}

}  // namespace fresco
