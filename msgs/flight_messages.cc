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

std::vector<flight_t> FlightMessages(const World& world, const Flight& flight, const std::string& policy) {
  std::vector<flight_t> messages;
  Environment environment(world);  // flies the actions again: a Flight does not hold rewards and margins
  flight_t message{};
  message.policy = policy.substr(0, kMaximumPolicyBytes);
  for (const FlightSlot& slot : flight.slots) {
    SetState(world, environment.state(), message);
    message.remaining_energy_j = static_cast<float>(environment.remaining_energy_j());
    message.outcome = static_cast<int8_t>(environment.outcome());
    message.move = static_cast<int8_t>(slot.action.move);
    message.scheduled = static_cast<int16_t>(slot.action.schedule);
    const bool flying = environment.outcome() == Outcome::kFlying;
    message.reward = flying ? static_cast<float>(environment.Step(slot.action).reward) : 0.0f;
    messages.push_back(message);
  }
  return messages;
}

}  // namespace fresco
