// The reinforcement learning environment: reset, step, mask. It follows the choices listed in docs/paper.md.
// Deterministic. Only one thread at a time may use an instance. Does not allocate after construction.
#pragma once

#include <cstdint>
#include <span>

#include "worlds/uav/world.h"

namespace fresco {

/// How an episode ended.
enum class Outcome : uint8_t {
  kFlying = 0,       ///< it has not ended
  kArrived = 1,      ///< the UAV is over the stop at slot T, and Delta >= 0
  kOutOfTime = 2,    ///< phi < 0, whatever Delta is
  kOutOfEnergy = 3,  ///< Delta < 0 and phi >= 0
};
/// "flying", "arrived", "out of time" or "out of energy".
const char* OutcomeName(Outcome outcome);

/// Which actions the mask forbids.
struct MaskOptions {
  bool safe_actions = false;  ///< forbid moves off the grid, and moves after which the stop can't be reached
  bool coverage = false;      ///< forbid scheduling sensors that the UAV does not cover now
};

struct StepResult {
  double reward = 0;
  Outcome outcome = Outcome::kFlying;
  bool terminal() const { return outcome != Outcome::kFlying; }
};

class Environment {
 public:
  /// `world` must outlive the environment.
  explicit Environment(const World& world);

  /// Begins a new episode: slot 1, the UAV over the start, every AoI 1, full energy.
  void Reset();

  const State& state() const { return state_; }
  /// Energy on board, joules.
  double remaining_energy_j() const { return remaining_j_; }
  Outcome outcome() const { return outcome_; }

  /// Flies one slot: the scheduled sensor transmits while the UAV is over o_t, then the UAV moves. CHECKs
  /// that the episode is not over and that the sensor's number is 0 .. N. The reward is r_t of docs/paper.md;
  /// a move that breaks both constraints costs both penalties.
  StepResult Step(Action action);

  /// Writes 1 to mask[a] if the action with index a is allowed now, otherwise 0. CHECKs that `mask` has
  /// actions() entries. Without options every action is allowed, and so it is once the episode is over. If no
  /// move is safe (which happens only after flying without the mask), all moves are allowed, so there is
  /// always an allowed action.
  void WriteMask(MaskOptions options, std::span<uint8_t> mask) const;

  /// Whether the move stays on the grid and the stop can still be reached after it.
  bool IsSafe(Move move) const;

 private:
  void Collect(int schedule);
  double SlotEnergy(Cell next) const;
  void UpdateMargins();
  Outcome PresentOutcome() const;
  double RewardOfState() const;

  const World* world_;
  State state_;
  double remaining_j_ = 0;
  Outcome outcome_ = Outcome::kFlying;
};

}  // namespace fresco
