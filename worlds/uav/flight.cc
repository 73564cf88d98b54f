#include "worlds/uav/flight.h"

#include <algorithm>

#include "core/error.h"

namespace fresco {

void AoiAccumulator::Add(std::span<const int16_t> aoi) {
  FRESCO_CHECK(aoi.size() == static_cast<size_t>(world_->sensors()));
  FRESCO_CHECK(slots_ < world_->scenario().slots);
  for (size_t sensor = 0; sensor < aoi.size(); ++sensor) {
    total_ += aoi[sensor];
    weighted_ += world_->theta()[sensor] * aoi[sensor];
  }
  last_.assign(aoi.begin(), aoi.end());
  ++slots_;
}

AoiFigures AoiAccumulator::Finish() const {
  FRESCO_CHECK(slots_ >= 1);
  const int slots = world_->scenario().slots;
  const int cap = world_->scenario().maximum_aoi.value_or(slots);
  AoiAccumulator completed = *this;
  std::vector<int16_t> aoi = last_;
  while (completed.slots_ < slots) {
    for (int16_t& value : aoi) {
      value = static_cast<int16_t>(std::min(value + 1, cap));
    }
    completed.Add(aoi);
  }
  return {completed.total_, completed.weighted_ / slots, static_cast<double>(completed.total_) / slots};
}

AoiFigures Figures(const World& world, const Flight& flight) {
  AoiAccumulator accumulator(world);
  for (const FlightSlot& slot : flight.slots) {
    accumulator.Add(slot.state.aoi);
  }
  return accumulator.Finish();
}

double GapPercent(double average_aoi, double least_average_aoi) {
  return 100 * (average_aoi - least_average_aoi) / least_average_aoi;
}

Flight Fly(const World& world, const std::function<Action(const Environment&)>& policy) {
  Environment environment(world);
  Flight flight;
  while (environment.outcome() == Outcome::kFlying) {
    const Action action = policy(environment);
    flight.slots.push_back({environment.state(), action});
    flight.total_reward += environment.Step(action).reward;
  }
  flight.slots.push_back({environment.state(), Action{}});
  flight.outcome = environment.outcome();
  flight.residual_energy_j = environment.remaining_energy_j();
  return flight;
}

Flight FlyBaseline(const World& world, BaselineKind kind) {
  Baseline baseline(kind, world);
  return Fly(world, [&](const Environment& environment) { return baseline.Choose(environment); });
}

}  // namespace fresco
