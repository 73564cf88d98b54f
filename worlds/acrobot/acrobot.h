// Acrobot: two links hang from a fixed joint, and a motor at the joint between them must swing the free end
// up. The equations are those of Sutton, "Generalization in reinforcement learning: successful examples using
// sparse coarse coding", 1996, as corrected in Sutton and Barto's book; constants, limits and rewards are
// those of Gymnasium's Acrobot-v1. So returns can be compared with published ones.
#pragma once

#include <array>
#include <memory>
#include <numbers>
#include <span>

#include "worlds/world.h"

namespace fresco {

/// State: the angle of the first link (rad, 0 is hanging down), the angle of the second link against the
/// first (rad, 0 is straight), both in [-pi, pi], and their angular velocities (rad/s). It is simulated in
/// double; a state has the values as floats.
///
/// Actions: a torque of -1, 0 or +1 N m between the links for 0.2 s.
///
/// An episode starts with all four fields uniform in [-0.1, 0.1): the first four draws of RandomStream(seed,
/// kEpisodeStart, 0, 0), in the order of the fields. It is terminal once the free end is more than 1 m above
/// the fixed joint, otherwise truncated after the maximum of steps. A step earns 0 if it reaches this height,
/// otherwise -1. The figure is the return; an episode that reached the height succeeded.
///
/// Observation [6]: cosine and sine of the first angle, cosine and sine of the second, the first angular
/// velocity / 4 pi, the second / 9 pi.
class Acrobot : public World {
 public:
  /// The fields in double, in the order above.
  using State = std::array<double, 4>;
  static constexpr double kMaximumVelocity1 = 4 * std::numbers::pi;  ///< rad/s
  static constexpr double kMaximumVelocity2 = 9 * std::numbers::pi;  ///< rad/s

  /// `maximum_steps` is 1 to kMaximumEpisode (CHECKed); Acrobot-v1 has 500.
  explicit Acrobot(int maximum_steps);

  std::unique_ptr<Environment> NewEnvironment() const override;
  void Observe(std::span<const float> state, std::span<float> observation) const override;
  std::optional<StateFormulas> Formulate(Formulas& formulas) const override;
  bool Succeeded(const Episode& episode) const override;

  /// The state 0.2 s later under a torque of `torque_nm` newton metres: one step of the fourth-order
  /// Runge-Kutta method. Then the angles are wrapped and the velocities are limited to the maximums above.
  static State After(const State& state, double torque_nm);

  /// Whether the free end is more than 1 m above the fixed joint.
  static bool IsUp(const State& state);
};

}  // namespace fresco
