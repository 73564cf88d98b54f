#include "msgs/flight_messages.h"

#include <numeric>

namespace fresco {
namespace {

void SetState(const World& world, const State& state, flight_t& message) {
  message.slot = state.slot;
  message.slots = world.scenario().slots;
  message.column = static_cast<int16_t>(state.cell.column);
  message.row = static_cast<int16_t>(state.cell.row);
  message.time_margin = static_cast<int16_t>(state.time_margin);
  message.energy_margin_j = state.energy_margin_j;
  message.sensor_count = world.sensors();
  message.aoi = state.aoi;
  message.total_aoi += std::accumulate(state.aoi.begin(), state.aoi.end(), int64_t{0});
}

}  // namespace

std::vector<flight_t> FlightMessages(const World& world, const Episode& flight, const std::string& policy) {
  std::vector<flight_t> messages;
  flight_t message{};
  message.policy = policy.substr(0, kMaximumPolicyBytes);
  for (size_t slot = 0; slot < flight.states.size(); ++slot) {
    const bool last = slot == flight.actions.size();
    const Action action = ActionIn(world, flight, slot);
    SetState(world, flight.states[slot], message);
    message.remaining_energy_j = static_cast<float>(EnergyIn(world, flight, slot));
    message.outcome = static_cast<int8_t>(last ? flight.outcome : Outcome::kFlying);
    message.move = static_cast<int8_t>(action.move);
    message.scheduled = static_cast<int16_t>(action.schedule);
    message.reward = last ? 0.0f : flight.rewards[slot];
    messages.push_back(message);
  }
  return messages;
}

}  // namespace fresco
