// The environment of the UAV's world: reset, step, mask. It follows the choices listed in docs/paper.md.
// Deterministic. Only one thread at a time may use an instance. Does not allocate after construction.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "worlds/uav/uav_world.h"

namespace fresco {

/// How a flight ended, in more detail than Ending says.
enum class Outcome : uint8_t {
  kFlying = 0,       ///< it has not ended
  kArrived = 1,      ///< the UAV is over the stop at slot T, and Delta >= 0
  kOutOfTime = 2,    ///< phi < 0, whatever Delta is
  kOutOfEnergy = 3,  ///< Delta < 0 and phi >= 0
};
/// "flying", "arrived", "out of time" or "out of energy".
const char* OutcomeName(Outcome outcome);
/// The outcome of a flight that ended with these margins phi and Delta.
Outcome FinalOutcome(float time_margin, float energy_margin_j);

class UavEnvironment : public Environment {
 public:
  /// `world` must outlive the environment.
  explicit UavEnvironment(const UavWorld& world);

  /// Begins a new episode: slot 1, the UAV over the start, every AoI 1, full energy. The seed decides
  /// nothing.
  void Reset(uint64_t seed = 0) override;

  const UavState& state() const { return state_; }
  /// Energy on board, joules.
  double remaining_energy_j() const { return remaining_j_; }
  Outcome outcome() const { return outcome_; }

  /// Flies one slot: the scheduled sensor transmits while the UAV is over o_t, then the UAV moves. CHECKs
  /// that the episode is not over and that the sensor's number is 0 .. N. The reward is r_t of docs/paper.md;
  /// a move that breaks both constraints costs both penalties.
  StepResult Step(Action action);
  StepResult Step(int action) override { return Step(world_->ActionAt(action)); }

  void CopyFrom(const Environment& other) override { *this = static_cast<const UavEnvironment&>(other); }

  void WriteState(std::span<float> state) const override;

  /// Writes 1 to mask[a] if the action with index a is allowed now, otherwise 0. CHECKs that `mask` has
  /// actions() entries. Without options every action is allowed, and so it is once the episode is over. If no
  /// move is safe (which happens only after flying without the mask), all moves are allowed, so there is
  /// always an allowed action.
  void WriteMask(MaskOptions options, std::span<uint8_t> mask) const;
  /// The same with the world's options.
  void WriteMask(std::span<uint8_t> mask) const override { WriteMask(world_->mask_options(), mask); }

  /// Whether the move stays on the grid and off cells that can't be flown over, and the stop can still be
  /// reached after it.
  bool IsSafe(Move move) const { return SafeMoves()[static_cast<size_t>(move)] != 0; }

 private:
  std::array<uint8_t, kMoves> SafeMoves() const;
  void Collect(int schedule);
  void UpdateMargins();
  Outcome PresentOutcome() const;
  double RewardOfState() const;

  const UavWorld* world_;
  UavState state_;
  double remaining_j_ = 0;
  Outcome outcome_ = Outcome::kFlying;
};

}  // namespace fresco
