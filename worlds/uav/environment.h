// The UAV's world as an environment: reset, step, mask. Follows the choices listed in
// docs/paper.md. Deterministic; one instance is used by one thread at a time; no allocation after
// construction.
#pragma once

#include <cstdint>
#include <span>

#include "worlds/uav/world.h"

namespace fresco {

enum class Outcome : uint8_t {
  kFlying = 0,
  kArrived = 1,      ///< over the stop at slot T with Delta >= 0
  kOutOfTime = 2,    ///< phi < 0, whatever Delta is
  kOutOfEnergy = 3,  ///< Delta < 0 and phi >= 0
};
const char* OutcomeName(Outcome outcome);

/// Which actions the mask leaves out.
struct MaskOptions {
  bool safe_actions = false;  ///< moves off the grid or to where the stop is out of reach
  bool coverage = false;      ///< schedules of sensors that the UAV does not cover now
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

  /// Back to slot 1 over the start with AoI 1.
  void Reset();

  const State& state() const { return state_; }
  double remaining_energy_j() const { return remaining_j_; }
  Outcome outcome() const { return outcome_; }

  /// One slot: the scheduled sensor transmits from o_t, then the UAV moves. CHECKs that the episode
  /// is not over. The reward is r_t of docs/paper.md; where one move breaks both constraints, both
  /// penalties are charged.
  StepResult Step(Action action);

  /// mask[a] = 1 where the action of index a is allowed now; `mask` has actions() entries. With no
  /// option every action is allowed. Once the episode is over, all are allowed (no next action).
  /// Where no move is safe (only by flying without the mask), none is left out, so at least one
  /// action is always allowed.
  void WriteMask(MaskOptions options, std::span<uint8_t> mask) const;

  /// Whether the move leads to where the stop can still be reached, and stays on the grid.
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
