#include "worlds/cartpole/cartpole.h"

#include <cmath>

#include "core/error.h"
#include "worlds/episode.h"
#include "worlds/numeric_environment.h"
#include "worlds/trigonometry.h"

namespace fresco {
namespace {

StepResult AdvanceCartPole(int action, CartPole::State& state) {
  constexpr double kForceN = 10;
  FRESCO_CHECK(action == 0 || action == 1);
  state = CartPole::After(state, action == 1 ? kForceN : -kForceN);
  return {1, CartPole::HasFailed(state) ? Ending::kTerminal : Ending::kNone};
}

// What the network sees of a state's fields is divided by these.
constexpr std::array kUnits = {static_cast<float>(CartPole::kMaximumPositionM), 2.0f,
                               static_cast<float>(CartPole::kMaximumAngleRad), 2.0f};

WorldDescription DescribeCartPole(int maximum_steps) {
  WorldDescription description;
  description.name = "cartpole";
  description.state = {
      {"position", "m"}, {"velocity", "m/s"}, {"angle", "rad"}, {"angular_velocity", "rad/s"}};
  description.actions = {"push left", "push right"};
  description.observation_size = 4;
  description.longest_episode = maximum_steps;
  description.discount = 0.99;
  description.chance = false;
  description.copies = true;
  description.figures = {{"return", ""}};
  description.success = "balanced";
  return description;
}

}  // namespace

CartPole::CartPole(int maximum_steps) : World(DescribeCartPole(maximum_steps)) {}

std::unique_ptr<Environment> CartPole::NewEnvironment() const {
  return std::make_unique<NumericEnvironment<4, AdvanceCartPole>>(0.05, longest_episode());
}

void CartPole::Observe(std::span<const float> state, std::span<float> observation) const {
  FRESCO_CHECK(state.size() == kUnits.size() && observation.size() == kUnits.size());
  for (size_t field = 0; field < kUnits.size(); ++field) {
    observation[field] = state[field] / kUnits[field];
  }
}

std::optional<StateFormulas> CartPole::Formulate(Formulas& formulas) const {
  const Term units = formulas.Single({kUnits.begin(), kUnits.end()});
  return StateFormulas{formulas.State(0, 4) / units, formulas.Single({1, 1})};
}

bool CartPole::Succeeded(const Episode& episode) const {
  return episode.ending == Ending::kTruncated;
}

CartPole::State CartPole::After(const State& state, double force_n) {
  constexpr double kGravity = 9.8;  // m/s^2
  constexpr double kPoleKg = 0.1;   // the cart has 1 kg
  constexpr double kPerTotalKg = 1 / 1.1;
  constexpr double kHalfLengthM = 0.5;  // of the pole
  constexpr double kStepS = 0.02;
  const auto [position, velocity, angle, angular_velocity] = state;
  const auto [sine, cosine] = SineAndCosineOf(angle);
  // The cart's acceleration if the pole did not turn faster or slower.
  const double push =
      (force_n + kPoleKg * kHalfLengthM * angular_velocity * angular_velocity * sine) * kPerTotalKg;
  const double angular_acceleration = (kGravity * sine - cosine * push) /
                                      (kHalfLengthM * (4.0 / 3 - kPoleKg * kPerTotalKg * cosine * cosine));
  const double acceleration = push - kPoleKg * kHalfLengthM * kPerTotalKg * angular_acceleration * cosine;
  return {position + kStepS * velocity, velocity + kStepS * acceleration, angle + kStepS * angular_velocity,
          angular_velocity + kStepS * angular_acceleration};
}

bool CartPole::HasFailed(const State& state) {
  return std::abs(state[0]) > kMaximumPositionM || std::abs(state[2]) > kMaximumAngleRad;
}

}  // namespace fresco
