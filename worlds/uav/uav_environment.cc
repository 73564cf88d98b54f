#include "worlds/uav/uav_environment.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "core/error.h"

namespace fresco {
namespace {

// UavWorld::After, and the distance to the stop. Without a map, which is usual, nothing is looked up and
// little is decided by branches, which are hard to predict.
template <bool kHasMap>
Cell CellAfter(const UavWorld& world, Cell cell, Move move) {
  if constexpr (kHasMap) {
    return world.After(cell, move);
  }
  const Cell step = kMoveSteps[static_cast<size_t>(move)];
  const Cell next = {cell.column + step.column, cell.row + step.row};
  return world.OnGrid(next) ? next : cell;
}

template <bool kHasMap>
int MovesToStop(const UavWorld& world, Cell cell) {
  const Cell stop = world.scenario().stop;
  return kHasMap ? world.DistanceToStop(cell)
                 : std::abs(cell.column - stop.column) + std::abs(cell.row - stop.row);
}

/// Sets both margins of the state's slot and cell.
template <bool kHasMap>
void SetMargins(const UavWorld& world, double remaining_j, UavState& state) {
  const int slots_left = world.scenario().slots - state.slot;
  const int distance = MovesToStop<kHasMap>(world, state.cell);
  state.time_margin = slots_left - distance;
  state.energy_margin_j = static_cast<float>(EnergyMargin(world, distance, slots_left, remaining_j));
}

/// Flies one slot: changes everything but the ages. A move that leaves the UAV where it is takes the energy
/// of a hover.
template <bool kHasMap>
void FlySlot(const UavWorld& world, Move move, double& remaining_j, UavState& state) {
  const Cell next = CellAfter<kHasMap>(world, state.cell, move);
  remaining_j -= next == state.cell ? world.hovering_energy_j() : world.flying_energy_j();
  state.cell = next;
  ++state.slot;
  SetMargins<kHasMap>(world, remaining_j, state);
}

}  // namespace

const char* OutcomeName(Outcome outcome) {
  switch (outcome) {
    case Outcome::kFlying:
      return "flying";
    case Outcome::kArrived:
      return "arrived";
    case Outcome::kOutOfTime:
      return "out of time";
    case Outcome::kOutOfEnergy:
      return "out of energy";
  }
  CheckFailed(__FILE_NAME__, __LINE__, "an outcome of 0 to 3");
}

Outcome FinalOutcome(float time_margin, float energy_margin_j) {
  if (time_margin < 0) {
    return Outcome::kOutOfTime;
  }
  return energy_margin_j < 0 ? Outcome::kOutOfEnergy : Outcome::kArrived;
}

UavEnvironment::UavEnvironment(const UavWorld& world) : world_(&world) {
  UavEnvironment::Reset();  // by its full name: in a constructor no call is virtual
}

void UavEnvironment::Reset(uint64_t) {
  state_.slot = 1;
  state_.cell = world_->scenario().start;
  state_.aoi.assign(static_cast<size_t>(world_->sensors()), 1);
  remaining_j_ = world_->scenario().initial_energy_j;
  outcome_ = Outcome::kFlying;
  UpdateMargins();
}

StepResult UavEnvironment::Step(Action action) {
  FRESCO_CHECK(outcome_ == Outcome::kFlying);
  FRESCO_CHECK(action.schedule >= 0 && action.schedule <= world_->sensors());
  Collect(action.schedule);  // from o_t, before the move
  if (world_->map() == nullptr) {
    FlySlot<false>(*world_, action.move, remaining_j_, state_);
  } else {
    FlySlot<true>(*world_, action.move, remaining_j_, state_);
  }
  outcome_ = PresentOutcome();
  return {RewardOfState(), outcome_ == Outcome::kFlying ? Ending::kNone : Ending::kTerminal};
}

void UavEnvironment::WriteState(std::span<float> state) const {
  FRESCO_CHECK(state.size() == kAoiField + state_.aoi.size());
  state[kColumnField] = static_cast<float>(state_.cell.column);
  state[kRowField] = static_cast<float>(state_.cell.row);
  state[kTimeMarginField] = static_cast<float>(state_.time_margin);
  state[kEnergyMarginField] = state_.energy_margin_j;
  std::copy(state_.aoi.begin(), state_.aoi.end(), state.begin() + kAoiField);
}

// Eq. (Dynamic-AoI). If the scenario has a maximum_aoi, AoI grows no further than that.
void UavEnvironment::Collect(int schedule) {
  const int cap = world_->scenario().maximum_aoi.value_or(world_->scenario().slots);
  for (int sensor = 0; sensor < world_->sensors(); ++sensor) {
    const bool collected = schedule == sensor + 1 && world_->Covers(state_.cell, sensor);
    int16_t& aoi = state_.aoi[static_cast<size_t>(sensor)];
    aoi = collected ? int16_t{1} : static_cast<int16_t>(std::min(aoi + 1, cap));
  }
}

void UavEnvironment::UpdateMargins() {
  if (world_->map() == nullptr) {
    SetMargins<false>(*world_, remaining_j_, state_);
  } else {
    SetMargins<true>(*world_, remaining_j_, state_);
  }
}

// If no slot is left, phi >= 0 means that the UAV is over the stop. Rounding Delta to float keeps its sign,
// since Delta is either zero or far above the smallest float.
Outcome UavEnvironment::PresentOutcome() const {
  const bool ended =
      state_.slot == world_->scenario().slots || state_.time_margin < 0 || state_.energy_margin_j < 0;
  return ended ? FinalOutcome(static_cast<float>(state_.time_margin), state_.energy_margin_j)
               : Outcome::kFlying;
}

double UavEnvironment::RewardOfState() const {
  double weighted_aoi = 0;
  for (size_t sensor = 0; sensor < state_.aoi.size(); ++sensor) {
    weighted_aoi += world_->theta()[sensor] * state_.aoi[sensor];
  }
  const Reward& constants = world_->scenario().reward;
  double reward = -weighted_aoi / world_->scenario().slots;
  reward -= state_.time_margin < 0 ? constants.k1 : 0;
  reward -= state_.energy_margin_j < 0 ? constants.k2 : 0;
  reward += outcome_ == Outcome::kArrived ? constants.k3 : 0;
  return reward;
}

// All moves to cells that are as far from the stop are alike. There are few branches, since they are hard to
// predict.
std::array<uint8_t, kMoves> UavEnvironment::SafeMoves() const {
  const UavWorld& world = *world_;
  const Cell cell = state_.cell;
  const int slots_left = world.scenario().slots - state_.slot - 1;
  const int distance = world.DistanceToStop(cell);
  const double after_flight_j = remaining_j_ - world.flying_energy_j();
  const uint8_t farther = CanReachStop(world, distance + 1, slots_left, after_flight_j);
  const uint8_t closer = CanReachStop(world, distance - 1, slots_left, after_flight_j);
  std::array<uint8_t, kMoves> safe{};
  for (size_t move = 0; move < static_cast<size_t>(Move::kHover); ++move) {
    const Cell next = {cell.column + kMoveSteps[move].column, cell.row + kMoveSteps[move].row};
    if (world.map() != nullptr && !world.map()->MayFly(next)) {
      continue;  // it has no distance
    }
    safe[move] =
        static_cast<uint8_t>(world.OnGrid(next)) & (world.DistanceToStop(next) < distance ? closer : farther);
  }
  safe[static_cast<size_t>(Move::kHover)] =
      CanReachStop(world, distance, slots_left, remaining_j_ - world.hovering_energy_j());
  return safe;
}

void UavEnvironment::WriteMask(MaskOptions options, std::span<uint8_t> mask) const {
  FRESCO_CHECK(mask.size() == static_cast<size_t>(world_->actions()));
  std::array<uint8_t, kMoves> allowed{};
  if (options.safe_actions) {
    allowed = SafeMoves();
  }
  if ((allowed[0] | allowed[1] | allowed[2] | allowed[3] | allowed[4]) == 0) {
    allowed.fill(1);  // no option, the stop is out of reach already, or the episode is over
  }
  const bool is_over = outcome_ != Outcome::kFlying;
  const uint8_t any_sensor = !options.coverage || is_over;
  const std::span<const uint8_t> coverage = world_->Coverage(state_.cell);
  const size_t schedules = coverage.size() + 1;
  uint8_t covers_one = 0;
  for (const uint8_t covered : coverage) {
    covers_one |= covered;
  }
  const uint8_t idle = !options.idle || is_over || covers_one == 0;
  for (size_t move = 0; move < kMoves; ++move) {
    mask[move * schedules] = allowed[move] & idle;
  }
  for (size_t schedule = 1; schedule < schedules; ++schedule) {
    const uint8_t useful = any_sensor | coverage[schedule - 1];
    for (size_t move = 0; move < kMoves; ++move) {
      mask[move * schedules + schedule] = allowed[move] & useful;
    }
  }
}

}  // namespace fresco
