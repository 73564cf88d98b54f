// CartPole: a cart on a track is pushed left or right, and the pole on it must not fall. The equations are
// those of Barto, Sutton and Anderson, "Neuronlike adaptive elements that can solve difficult learning
// control problems", 1983, without friction; constants, limits and rewards are those of Gymnasium's
// CartPole-v1. So returns can be compared with published ones.
#pragma once

#include <array>
#include <memory>
#include <numbers>
#include <span>

#include "worlds/world.h"

namespace fresco {

/// State: position (m, the middle of the track is 0, right is positive), velocity (m/s), angle (rad, upright
/// is 0, to the right is positive) and angular velocity (rad/s). It is simulated in double; a state has the
/// values as floats.
///
/// Actions: 0 pushes left, 1 pushes right, both with 10 N for 0.02 s.
///
/// An episode starts with all four fields uniform in [-0.05, 0.05): the first four draws of
/// RandomStream(seed, kEpisodeStart, 0, 0), in the order of the fields. It is terminal after a step to
/// |position| > 2.4 m or |angle| > 12 degrees, otherwise truncated after the maximum of steps. Each step
/// earns 1, the last one, too. The figure is the return; an episode that was truncated succeeded.
///
/// Observation [4]: position / 2.4 m, velocity / 2 m/s, angle / 12 degrees, angular velocity / 2 rad/s.
class CartPole : public World {
 public:
  /// The fields in double, in the order above.
  using State = std::array<double, 4>;
  static constexpr double kMaximumPositionM = 2.4;
  static constexpr double kMaximumAngleRad = 12 * 2 * std::numbers::pi / 360;

  /// `maximum_steps` is 1 to kMaximumEpisode (CHECKed); CartPole-v1 has 500.
  explicit CartPole(int maximum_steps);

  std::unique_ptr<Environment> NewEnvironment() const override;
  void Observe(std::span<const float> state, std::span<float> observation) const override;
  std::optional<StateFormulas> Formulate(Formulas& formulas) const override;
  bool Succeeded(const Episode& episode) const override;

  /// The state 0.02 s later if the cart is pushed with `force_n` newtons (positive: to the right). One step
  /// of the explicit Euler method: position and angle advance with the velocities before the step.
  static State After(const State& state, double force_n);

  /// Whether the cart is off its track or the pole has fallen.
  static bool HasFailed(const State& state);
};

}  // namespace fresco
