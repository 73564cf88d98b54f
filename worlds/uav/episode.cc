#include "worlds/uav/episode.h"

#include <algorithm>
#include <cstring>

#include "core/memory.h"

namespace fresco {
namespace {

bool IsSameState(const State& a, const State& b) {
  return a.slot == b.slot && a.cell == b.cell && a.time_margin == b.time_margin &&
         std::memcmp(&a.energy_margin_j, &b.energy_margin_j, sizeof a.energy_margin_j) == 0 && a.aoi == b.aoi;
}

}  // namespace

void Episode::Clear() {
  outcome = Outcome::kFlying;
  states.clear();
  actions.clear();
  rewards.clear();
  next_masks.clear();
}

void AppendMask(std::span<const uint8_t> mask, std::vector<uint8_t>& packed) {
  const size_t begin = packed.size();
  packed.resize(begin + (mask.size() + 7) / 8, 0);
  for (size_t action = 0; action < mask.size(); ++action) {
    if (mask[action] != 0) {
      packed[begin + action / 8] = static_cast<uint8_t>(packed[begin + action / 8] | (1u << (action % 8)));
    }
  }
}

int64_t LongestEpisodeBytes(const World& world) {
  const int64_t transitions = world.maximum_transitions();
  const auto state_bytes = static_cast<int64_t>(sizeof(State)) +
                           HeapBytes(world.sensors() * static_cast<int64_t>(sizeof(int16_t)));
  const auto transition_bytes = static_cast<int64_t>(sizeof(int16_t) + sizeof(float)) + MaskSize(world);
  return static_cast<int64_t>(sizeof(Episode)) + (transitions + 1) * state_bytes +
         transitions * transition_bytes;
}

Action ActionIn(const World& world, const Episode& episode, size_t slot) {
  return slot < episode.actions.size() ? world.ActionAt(episode.actions[slot]) : Action{};
}

double EnergyIn(const World& world, const Episode& episode, size_t slot) {
  double remaining_j = world.scenario().initial_energy_j;
  for (size_t i = 0; i < slot; ++i) {
    const bool hovered = episode.states[i].cell == episode.states[i + 1].cell;
    remaining_j -= hovered ? world.hovering_energy_j() : world.flying_energy_j();
  }
  return remaining_j;
}

bool IsPartOf(const Episode& part, int first, const Episode& episode) {
  const int end = first + part.transitions();
  if (first < 0 || part.transitions() == 0 || end > episode.transitions()) {
    return false;
  }
  const auto agrees = [](const auto& values, const auto& all, size_t begin, auto same) {
    return begin + values.size() <= all.size() &&
           std::equal(values.begin(), values.end(), all.begin() + static_cast<int64_t>(begin), same);
  };
  const auto at = static_cast<size_t>(first);
  const size_t mask_size = episode.next_masks.size() / episode.actions.size();
  return agrees(part.states, episode.states, at, IsSameState) &&
         agrees(part.actions, episode.actions, at, std::equal_to<>()) &&
         agrees(part.rewards, episode.rewards, at, std::equal_to<>()) &&
         agrees(part.next_masks, episode.next_masks, at * mask_size, std::equal_to<>()) &&
         part.outcome == (end == episode.transitions() ? episode.outcome : Outcome::kFlying);
}

EpisodeRecorder::EpisodeRecorder(const World& world, MaskOptions mask_options)
    : world_(&world),
      mask_options_(mask_options),
      environment_(world),
      mask_(static_cast<size_t>(world.actions())) {
  environment_.WriteMask(mask_options_, mask_);
  episode_.states.push_back(environment_.state());
}

void EpisodeRecorder::Step(int action) {
  const StepResult result = environment_.Step(world_->ActionAt(action));
  environment_.WriteMask(mask_options_, mask_);
  episode_.actions.push_back(static_cast<int16_t>(action));
  episode_.rewards.push_back(static_cast<float>(result.reward));
  episode_.states.push_back(environment_.state());
  AppendMask(mask_, episode_.next_masks);
  episode_.outcome = result.outcome;
}

Episode Fly(const World& world, const std::function<Action(const Environment&)>& policy) {
  EpisodeRecorder recorder(world, {});
  while (recorder.episode().outcome == Outcome::kFlying) {
    recorder.Step(world.ActionIndex(policy(recorder.environment())));
  }
  return recorder.Release();
}

bool FlyActions(const World& world, MaskOptions mask_options, std::span<const int16_t> actions,
                Episode& episode) {
  EpisodeRecorder recorder(world, mask_options);
  for (const int16_t action : actions) {
    if (action < 0 || action >= world.actions() || recorder.mask()[static_cast<size_t>(action)] == 0) {
      return false;
    }
    recorder.Step(action);
    if (recorder.episode().outcome != Outcome::kFlying) {
      episode = recorder.Release();
      return true;
    }
  }
  return false;
}

}  // namespace fresco
