#include "training/episode_check.h"

#include <algorithm>
#include <cstring>

namespace fresco {
namespace {

bool SameState(const State& a, const State& b) {
  return a.slot == b.slot && a.cell == b.cell && a.time_margin == b.time_margin &&
         std::memcmp(&a.energy_margin_j, &b.energy_margin_j, sizeof a.energy_margin_j) == 0 && a.aoi == b.aoi;
}

}  // namespace

bool FlyActions(const World& world, MaskOptions mask_options, std::span<const int16_t> actions,
                Episode& episode) {
  episode.Clear();
  Environment environment(world);
  environment.Reset();
  std::vector<uint8_t> mask(static_cast<size_t>(world.actions()));
  environment.WriteMask(mask_options, mask);
  episode.states.push_back(environment.state());
  for (const int16_t action : actions) {
    if (action < 0 || action >= world.actions() || mask[static_cast<size_t>(action)] == 0) {
      return false;
    }
    const StepResult result = environment.Step(world.ActionAt(action));
    environment.WriteMask(mask_options, mask);
    episode.actions.push_back(action);
    episode.rewards.push_back(static_cast<float>(result.reward));
    episode.td_errors.push_back(0);
    episode.states.push_back(environment.state());
    AppendMask(mask, episode.next_masks);
    episode.outcome = result.outcome;
    if (result.terminal()) {
      return true;
    }
  }
  return false;
}

bool FollowsFromItsActions(const World& world, MaskOptions mask_options, const Episode& episode) {
  Episode flown;
  return FlyActions(world, mask_options, episode.actions, flown) &&
         flown.transitions() == episode.transitions() && flown.outcome == episode.outcome &&
         flown.rewards == episode.rewards && flown.next_masks == episode.next_masks &&
         std::equal(flown.states.begin(), flown.states.end(), episode.states.begin(), episode.states.end(),
                    SameState);
}

}  // namespace fresco
