#include "training/episode_check.h"

#include <algorithm>
#include <cstring>
#include <functional>

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

bool IsPartOf(const Episode& run, const Episode& episode) {
  const int first = run.first_transition;
  const int end = first + run.transitions();
  if (first < 0 || run.transitions() == 0 || end > episode.transitions()) {
    return false;
  }
  const auto agrees = [](const auto& part, const auto& whole, size_t begin, auto same) {
    return begin + part.size() <= whole.size() &&
           std::equal(part.begin(), part.end(), whole.begin() + static_cast<int64_t>(begin), same);
  };
  const auto at = static_cast<size_t>(first);
  const size_t mask_size = episode.next_masks.size() / episode.actions.size();
  return agrees(run.states, episode.states, at, SameState) &&
         agrees(run.actions, episode.actions, at, std::equal_to<>()) &&
         agrees(run.rewards, episode.rewards, at, std::equal_to<>()) &&
         agrees(run.next_masks, episode.next_masks, at * mask_size, std::equal_to<>()) &&
         run.outcome == (end == episode.transitions() ? episode.outcome : Outcome::kFlying);
}

}  // namespace fresco
