#include "worlds/uav/flight.h"

namespace fresco {

UavState StateIn(const Episode& episode, size_t i) {
  const std::span<const float> fields = episode.state(i);
  UavState state{static_cast<int>(i) + 1,
                 CellIn(fields),
                 static_cast<int>(fields[kTimeMarginField]),
                 fields[kEnergyMarginField],
                 {}};
  for (const float aoi : fields.subspan(kAoiField)) {
    state.aoi.push_back(static_cast<int16_t>(aoi));
  }
  return state;
}

std::vector<UavState> StatesIn(const Episode& episode) {
  std::vector<UavState> states;
  for (size_t i = 0; i <= episode.actions.size(); ++i) {
    states.push_back(StateIn(episode, i));
  }
  return states;
}

Outcome OutcomeOf(const Episode& episode) {
  const std::span<const float> last = episode.state(episode.actions.size());
  return episode.ending == Ending::kNone ? Outcome::kFlying
                                         : FinalOutcome(last[kTimeMarginField], last[kEnergyMarginField]);
}

Action ActionIn(const UavWorld& world, const Episode& episode, size_t i) {
  return i < episode.actions.size() ? world.ActionAt(episode.actions[i]) : Action{};
}

double EnergyIn(const UavWorld& world, const Episode& episode, size_t i) {
  double remaining_j = world.scenario().initial_energy_j;
  for (size_t slot = 0; slot < i; ++slot) {
    const bool hovered = CellIn(episode.state(slot)) == CellIn(episode.state(slot + 1));
    remaining_j -= hovered ? world.hovering_energy_j() : world.flying_energy_j();
  }
  return remaining_j;
}

Episode Fly(const UavWorld& world, const std::function<Action(const UavEnvironment&)>& policy) {
  EpisodeRecorder recorder(world, 0);
  while (!recorder.ended()) {
    const auto& environment = static_cast<const UavEnvironment&>(recorder.environment());
    recorder.Step(world.ActionIndex(policy(environment)));
  }
  return recorder.Release();
}

}  // namespace fresco
